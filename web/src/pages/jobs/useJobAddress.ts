import { useSearchParams } from "react-router";
import type { JobFilters } from "../../api/jobs";
import type { JobState } from "../../api/types";

export const JOB_STATES: readonly JobState[] = ["queued", "running", "succeeded", "failed", "cancelled"];

/** What the list of jobs is narrowed to, held by the address: a link shows a colleague the same list. */
export function useJobAddress(): [JobFilters, (changes: Partial<JobFilters>) => void] {
  const [address, setAddress] = useSearchParams();
  const text = (name: string): string | undefined => address.get(name) || undefined;
  const filters: JobFilters = {
    states: address.getAll("state").filter((state): state is JobState => JOB_STATES.includes(state as JobState)),
    recording: text("recording"),
    person: text("person"),
    batch: text("batch"),
    search: text("search"),
  };
  const change = (changes: Partial<JobFilters>): void => {
    const next = { ...filters, ...changes };
    const pairs = [...next.states.map((state) => ["state", state]), ...(["recording", "person", "batch", "search"] as const).flatMap((name) => (next[name] ? [[name, next[name]]] : []))];
    setAddress(new URLSearchParams(pairs), { replace: true });
  };
  return [filters, change];
}
