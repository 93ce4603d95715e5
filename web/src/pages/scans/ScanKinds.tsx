import { SegmentedControl } from "@mantine/core";
import { useNavigate } from "react-router";

const KINDS = [
  { value: "/scans", label: "Hands" },
  { value: "/scans/moving", label: "Moving people" },
];

/** The two kinds of scans, each with its own list. */
export function ScanKinds({ here }: { here: "/scans" | "/scans/moving" }) {
  const navigate = useNavigate();
  return <SegmentedControl size="xs" aria-label="Scans of what" data={KINDS} value={here} onChange={(to) => void navigate(to)} />;
}
