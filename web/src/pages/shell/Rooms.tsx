import { Badge } from "@mantine/core";
import { Link } from "react-router";
import classes from "./Shell.module.css";

const ROOMS = [
  { to: "/recordings", label: "Recordings" },
  { to: "/annotate", label: "Annotate" },
  { to: "/projects", label: "Projects" },
  { to: "/tracks", label: "Tracks" },
  { to: "/scans", label: "Scans" },
  { to: "/curate", label: "Curate" },
  { to: "/models", label: "Models" },
  { to: "/evaluations", label: "Evaluations" },
  { to: "/jobs", label: "Jobs" },
] as const;

/** Pages behind the menu of the person, which have no place among the rooms. */
const OTHERS: Readonly<Record<string, string>> = { "/bin": "Bin", "/people": "People", "/account": "Account", "/audit": "Audit trail", "/docs": "API" };

/** An annotator's address lies below its recording, but it is another room; what leads to recordings is in theirs. */
export function roomOf(path: string): string {
  if (path.endsWith("/annotate")) return "/annotate";
  return /^\/(imports|calibrations)/.test(path) ? "/recordings" : `/${path.split("/")[1] ?? ""}`;
}

export const nameOfRoom = (room: string): string => ROOMS.find(({ to }) => to === room)?.label ?? OTHERS[room] ?? "Handloom";

interface RoomsProps {
  room: string;
  /** Jobs under way. */
  running: number;
  /** One below the other, in the menu of a narrow screen. */
  isList?: boolean;
  onChosen?: () => void;
}

/** All rooms of the studio; the one that one is in is marked. */
export function Rooms({ room, running, isList = false, onChosen }: RoomsProps) {
  return (
    <nav aria-label="Rooms" className={isList ? classes.roomList : classes.rooms}>
      {ROOMS.map(({ to, label }) => (
        <Link key={to} to={to} className={`${classes.room} ${room === to ? classes.here : ""}`} aria-current={room === to ? "page" : undefined} onClick={onChosen}>
          {label}
          {to === "/jobs" && running > 0 && (
            <Badge size="sm" circle variant="filled" ml={6} aria-label={`${running} running`}>
              {running}
            </Badge>
          )}
        </Link>
      ))}
    </nav>
  );
}
