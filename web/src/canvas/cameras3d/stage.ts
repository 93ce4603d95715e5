/** The 3D view of calibrated cameras and of the boards they saw: draws when something has changed. */

import { BufferGeometry, CanvasTexture, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, PerspectiveCamera, Scene, Sprite, SpriteMaterial, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { centreOf, drawBoard, drawCamera, findBall, type Placed, type Point } from "./scene";

export interface ShownBoard {
  readonly T_world_board: readonly (readonly number[])[];
  readonly isLeftOut: boolean;
}

export interface Shown {
  readonly cameras: readonly Placed[];
  readonly boards: readonly ShownBoard[];
  /** m */
  readonly boardSize: readonly [number, number];
}

export interface CamerasStage {
  show: (shown: Shown) => void;
  lookFrom: (side: "behind" | "above" | "side") => void;
  resize: (width: number, height: number) => void;
  stop: () => void;
}

const FIELD_DEG = 40;
export const BOARD_COLORS = { fitted: "#5fae63", leftOut: "#b08cff" } as const;
const DIRECTIONS = { behind: new Vector3(0.35, 0.6, 1), above: new Vector3(0, 1, 0.001), side: new Vector3(1, 0.15, 0) } as const;

export function createCamerasStage(canvas: HTMLCanvasElement): CamerasStage {
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
  const scene = new Scene();
  const eye = new PerspectiveCamera(FIELD_DEG, 1, 0.01, 100);
  const controls = new OrbitControls(eye, canvas);
  controls.enableDamping = false;
  let world = new Group();
  let radius = 1;
  let frame = 0;

  const draw = (): void => {
    frame = 0;
    renderer.render(scene, eye);
  };
  const later = (): void => {
    if (frame === 0) frame = requestAnimationFrame(draw);
  };
  controls.addEventListener("change", later);

  const fitDistance = (): number => {
    const half = (FIELD_DEG * Math.PI) / 360;
    const room = eye.aspect < 1.2 ? 1.15 : 0.95; // names stand out of the ball where it fills the width
    return (room * radius) / Math.sin(Math.atan(Math.tan(half) * Math.min(1, eye.aspect)));
  };

  function lookFrom(side: keyof typeof DIRECTIONS): void {
    const distance = fitDistance();
    controls.target.set(0, 0, 0);
    eye.position.copy(DIRECTIONS[side].clone().normalize().multiplyScalar(distance));
    eye.near = distance / 100;
    eye.far = distance * 20;
    eye.updateProjectionMatrix();
    controls.update();
    later();
  }

  return {
    show({ cameras, boards, boardSize: [width, height] }) {
      dispose(world);
      scene.remove(world);
      world = new Group();
      const centres = cameras.map((camera) => centreOf(camera.T_world_camera));
      const outlines = boards.map(({ T_world_board: T, isLeftOut }) => ({ points: drawBoard(T, width, height), isLeftOut }));
      const ball = findBall([...centres, ...outlines.flatMap(({ points }) => points)]);
      radius = ball.radius;
      const depth = 0.18 * radius;
      for (const isLeftOut of [false, true]) {
        const own = outlines.filter((outline) => outline.isLeftOut === isLeftOut).flatMap(({ points }) => points);
        if (own.length > 0) world.add(drawLines(own, isLeftOut ? BOARD_COLORS.leftOut : BOARD_COLORS.fitted, 0.45));
      }
      cameras.forEach((camera, place) => {
        world.add(drawLines(drawCamera(camera, depth), camera.color, 1));
        const label = writeLabel(camera.id, camera.color, 0.1 * radius);
        const [x, y, z] = centres[place] ?? [0, 0, 0];
        label.position.set(x, y - 0.06 * radius, z);
        world.add(label);
      });
      // OpenCV's y points down and z forward; three's y up and z to the viewer.
      const [x, y, z] = ball.middle;
      const turned = new Group();
      world.position.set(-x, -y, -z);
      turned.add(world);
      turned.rotation.x = Math.PI;
      scene.clear();
      scene.add(turned);
      lookFrom("behind");
    },
    lookFrom,
    resize(width, height) {
      renderer.setSize(width, height, false);
      const before = fitDistance();
      eye.aspect = width / Math.max(1, height);
      eye.updateProjectionMatrix();
      eye.position.sub(controls.target).multiplyScalar(fitDistance() / before).add(controls.target);
      controls.update();
      draw();
    },
    stop() {
      cancelAnimationFrame(frame);
      dispose(world);
      controls.dispose();
      renderer.dispose();
    },
  };
}

function drawLines(points: readonly Point[], color: string, opacity: number): LineSegments {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(points.flat(), 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color, opacity, transparent: opacity < 1 }));
}

/** A name that always faces the viewer, `height` m high. */
function writeLabel(text: string, color: string, height: number): Sprite {
  const canvas = document.createElement("canvas");
  const pen = canvas.getContext("2d");
  const font = "600 40px Inter Variable, sans-serif";
  const name = text.length > 24 ? `${text.slice(0, 23)}…` : text;
  if (pen) {
    pen.font = font;
    canvas.width = Math.ceil(pen.measureText(name).width) + 24;
    canvas.height = 56;
    pen.font = font;
    pen.fillStyle = "rgb(16 18 21 / 80%)";
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.fillStyle = color;
    pen.textBaseline = "middle";
    pen.fillText(name, 12, 30);
  }
  const sprite = new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), depthTest: false }));
  sprite.scale.set((height * canvas.width) / canvas.height, height, 1);
  return sprite;
}

function dispose(group: Group): void {
  group.traverse((part) => {
    if (part instanceof LineSegments) {
      (part.geometry as BufferGeometry).dispose();
      (part.material as LineBasicMaterial).dispose();
    } else if (part instanceof Sprite) {
      part.material.map?.dispose();
      part.material.dispose();
    }
  });
}
