import { ActionIcon, Popover } from "@mantine/core";
import { IconInfoCircle } from "@tabler/icons-react";
import { Fragment, type ReactNode } from "react";
import classes from "./Timeline.module.css";

const box = (children: ReactNode) => (
  <svg width={28} height={14} viewBox="0 0 28 14" aria-hidden>
    <rect width={28} height={14} rx={2} fill="var(--surface-sunken)" />
    {children}
  </svg>
);

const STATES: readonly (readonly [ReactNode, string])[] = [
  [box(null), "not marked"],
  [box(<rect x={2} y={8} width={24} height={6} fill="var(--hand-right)" opacity={0.65} />), "partly marked: as high as the share of its joints"],
  [box(<rect x={2} width={24} height={14} fill="var(--hand-right)" />), "complete: every joint placed or outside"],
  [box(<path d="M14 1.5 19.5 7 14 12.5 8.5 7Z" fill="#fff" stroke="#111" strokeWidth={1.5} />), "key frame"],
  [box(<path d="M2 4H26" stroke="var(--suggestion)" strokeWidth={3} strokeDasharray="4 2" />), "suggested, not accepted yet"],
  [box(<path d="M9.5 2H18.5L14 11Z" fill="var(--bad)" />), "flagged by label QC"],
  [box(<path d="M3 7V11H25V7" stroke="var(--mantine-color-teal-5)" strokeWidth={2} fill="none" />), "submitted"],
  [box(<path d="M0 7H28" stroke="var(--text-quiet, currentColor)" strokeWidth={1} opacity={0.35} />), "not asked for, in a blind version"],
];

/** What the marks of the timeline mean. */
export function TimelineLegend({ hasTrack }: { hasTrack: boolean }) {
  return (
    <Popover position="top-end" withArrow shadow="md" returnFocus>
      <Popover.Target>
        <ActionIcon size={24} aria-label="What the timeline's marks mean">
          <IconInfoCircle size={15} />
        </ActionIcon>
      </Popover.Target>
      <Popover.Dropdown aria-label="Legend of the timeline">
        <div className={classes.legend}>
          {STATES.map(([sign, text]) => (
            <Fragment key={text}>
              {sign}
              <span>{text}</span>
            </Fragment>
          ))}
          {hasTrack && (
            <>
              {box(<path d="M3 14V10M8 14V6M13 14V9M18 14V3M23 14V8" stroke="#e8590c" strokeWidth={3} />)}
              <span>depth residual of the best track, and where it was lost</span>
            </>
          )}
        </div>
      </Popover.Dropdown>
    </Popover>
  );
}
