import { Stack, Text } from "@mantine/core";
import type { RestartCheck } from "../../api/jobChecks";
import type { Job } from "../../api/types";
import { joinWords } from "../../model/format";
import { Obstacles } from "../parts/Obstacles";

/** Of a job that failed or was cancelled: what is kept, what resume and try again would do, and what is in their way. */
export function Restart({ job, check }: { job: Job; check: RestartCheck | undefined }) {
  if (!check) return null;
  const { kept, retry } = check;
  const again = job.kind === "track" ? " Try again also reuses the fitted shape, unless the annotation of the first frame has changed." : " Try again starts over with the same parameters.";
  return (
    <Stack gap="sm" className="card" p="md" mb="md" component="section" aria-label="What is kept">
      <Text size="sm">
        {kept.length > 0
          ? `Kept: ${joinWords(kept)}. Resume continues from there.${again}`
          : "No step was finished. The job's input is unchanged; Try again starts over with the same parameters."}
      </Text>
      <Obstacles check={retry} />
    </Stack>
  );
}
