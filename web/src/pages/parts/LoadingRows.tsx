import { Skeleton, Stack } from "@mantine/core";

/** Where the rows of a list will be. */
export function LoadingRows({ count, height }: { count: number; height: number }) {
  return (
    <Stack gap="sm" role="status" aria-label="Loading">
      {Array.from({ length: count }, (_, index) => (
        <Skeleton key={index} height={height} />
      ))}
    </Stack>
  );
}
