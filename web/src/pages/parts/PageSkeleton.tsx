import { SimpleGrid, Skeleton } from "@mantine/core";

/** What a page shows while its code or its data is on the way. */
export function PageSkeleton() {
  return (
    <div className="page" role="status" aria-label="Loading">
      <Skeleton height={32} width={240} mb="lg" />
      <SimpleGrid cols={{ base: 2, sm: 3, lg: 4 }} spacing="md">
        {Array.from({ length: 4 }, (_, index) => (
          <Skeleton key={index} height={248} radius="lg" />
        ))}
      </SimpleGrid>
    </div>
  );
}
