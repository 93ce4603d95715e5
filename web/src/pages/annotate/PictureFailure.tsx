import { Text } from "@mantine/core";
import { useAnnotating } from "./annotating";
import classes from "./Annotator.module.css";

export function PictureFailure() {
  const { pictures, state } = useAnnotating();
  if (!pictures.failure) return null;
  return (
    <div className={`card ${classes.notice}`} role="alert">
      <Text size="sm" fw={600}>
        The picture of frame {state.frame} could not be loaded
      </Text>
      <Text size="xs">{pictures.failure.message} Annotations are safe; go to another frame and back to try again.</Text>
    </div>
  );
}
