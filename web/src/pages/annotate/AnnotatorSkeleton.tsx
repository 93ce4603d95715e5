import { Skeleton } from "@mantine/core";
import classes from "./Annotator.module.css";

/** The annotator's rooms, before there is anything in them; nothing jumps when it comes. */
export function AnnotatorSkeleton() {
  return (
    <div className={classes.page} role="status" aria-label="Loading">
      <div className={classes.bar}>
        <Skeleton height={16} width={240} />
      </div>
      <div className={classes.middle}>
        <div className={classes.railSpace} />
        <div className={classes.panes} />
        <div className={classes.panelSpace}>
          {Array.from({ length: 12 }, (_, index) => (
            <Skeleton key={index} height={16} my={10} mx={12} width="auto" />
          ))}
        </div>
      </div>
      <div className={classes.timeline}>
        <Skeleton height={40} />
      </div>
    </div>
  );
}
