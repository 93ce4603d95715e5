/** Konva's stage and the shapes that the studio draws: without the others and their filters the annotator is sent in fewer bytes. */
import "konva/lib/shapes/Circle";
import "konva/lib/shapes/Image";
import "konva/lib/shapes/Line";
import "konva/lib/shapes/Rect";
import "konva/lib/shapes/Text";

export { Circle, Group, Image, Layer, Line, Rect, Stage, Text } from "react-konva/lib/ReactKonvaCore";
