import { TagsInput } from "@mantine/core";
import type { ScanCollection } from "../../api/scans";

interface LeaveOutProps {
  collections: readonly ScanCollection[];
  /** The one that is trained from; without one all of them. */
  collection: string;
  value: string[];
  onChange: (subjects: string[]) => void;
}

/** People whose scans are kept for testing, chosen among those that are there. */
export function LeaveOut({ collections, collection, value, onChange }: LeaveOutProps) {
  const among = collections.filter(({ name }) => collection === "" || name === collection);
  const people = [...new Set(among.flatMap(({ subject_names: names }) => names))].sort((a, b) => a.localeCompare(b, undefined, { numeric: true }));
  return <TagsInput label="Subjects to leave out" description="Kept for testing" placeholder={value.length === 0 ? "None" : ""} data={people} value={value} onChange={onChange} />;
}
