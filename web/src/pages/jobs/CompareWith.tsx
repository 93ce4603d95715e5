import { Select } from "@mantine/core";
import { useNavigate } from "react-router";
import { useRecordingJobs } from "../../api/jobs";
import type { Job } from "../../api/types";
import { formatAgo } from "../../model/format";

/** Choose another run of the same recording to be put beside this one. */
export function CompareWith({ job }: { job: Job }) {
  const navigate = useNavigate();
  const others = useRecordingJobs(job.sequence_id).data?.filter((other) => other.id !== job.id) ?? [];
  if (others.length === 0) return null;
  return (
    <Select
      w={208}
      size="xs"
      aria-label="Compare with another run"
      placeholder="Compare with …"
      data={others.map((other) => ({ value: other.id, label: `${other.state}, ${formatAgo(other.created_at)} (${other.id.slice(0, 4)})` }))}
      value={null}
      onChange={(id) => id && void navigate(`/jobs/compare?a=${job.id}&b=${id}`)}
    />
  );
}
