import { Button, Checkbox, Group, NumberInput, Select, SimpleGrid, Skeleton, Stack, Table, Text, Title } from "@mantine/core";
import { FormDialog } from "../parts/Dialog";
import { useDisclosure } from "@mantine/hooks";
import { notifications } from "@mantine/notifications";
import { IconChecks, IconUsers } from "@tabler/icons-react";
import { useState } from "react";
import { Link, useSearchParams } from "react-router";
import { useAskSecondReview, useReviewAgreement, useThroughput, type ReviewAgreement } from "../../api/registrations";
import { useScanCollections } from "../../api/scans";
import { formatCount, formatNumber } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Fact } from "../parts/Fact";
import { Failure } from "../parts/Failure";
import { For } from "../parts/For";
import { useTitle } from "../parts/useTitle";
import classes from "./ReviewAgreementPage.module.css";

const EVERY = "";
const STANDINGS = ["accept", "reject", "unsure"] as const;
const share = (value: number | null): string => (value === null ? "–" : `${(100 * value).toFixed(1)} %`);

/** First person's decision by row, the second's by column. */
function PairTable({ pair }: { pair: ReviewAgreement["pairs"][number] }) {
  return (
    <section className="card" aria-label={`${pair.first_name} and ${pair.second_name}`} style={{ padding: 16 }}>
      <Title order={3} style={{ overflowWrap: "anywhere" }}>
        {pair.first_name} and {pair.second_name}
      </Title>
      <Text size="xs" className="quiet" mb="sm">
        {formatCount(pair.both, "registration")}; {share(pair.share_agreed)} alike; Cohen’s kappa {formatNumber(pair.kappa, 2)}. Rows: {pair.first_name}; columns: {pair.second_name}
      </Text>
      <table className={classes.confusion}>
        <thead>
          <tr>
            <td />
            {STANDINGS.map((one) => (
              <th key={one} scope="col" aria-label={`${pair.second_name}: ${one}`}>
                {one}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {STANDINGS.map((first) => (
            <tr key={first}>
              <th scope="row" aria-label={`${pair.first_name}: ${first}`}>
                {first}
              </th>
              {STANDINGS.map((second) => (
                <td key={second} data-same={first === second}>
                  {pair.table[first]?.[second] ?? 0}
                </td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

function AskDialog({ isOpen, onClose }: { isOpen: boolean; onClose: () => void }) {
  const collections = useScanCollections().data ?? [];
  const ask = useAskSecondReview();
  const [collection, setCollection] = useState(EVERY);
  const [percent, setPercent] = useState<number>(10);
  const [onlyDecided, setOnlyDecided] = useState(true);
  const submit = (): void =>
    ask.mutate(
      { collection: collection || null, share: Math.min(1, Math.max(0.001, percent / 100)), only_decided: onlyDecided },
      {
        onSuccess: ({ marked, already }) => {
          onClose();
          notifications.show({ color: "teal", message: `${formatCount(marked, "registration")} now wait for a second person; ${already} did already.` });
        },
      },
    );
  return (
    <FormDialog title="Ask for second reviews" size={520} isOpen={isOpen} onClose={onClose} onSubmit={submit} verb="Ask" isBusy={ask.isPending} failure={ask.error} failed="Nothing was asked for.">
      <Text size="sm" className="quiet">
        Somebody else decides about the same registrations without seeing what the first person said.
      </Text>
      <Group grow gap="md" align="flex-start">
        <Select label="Collection" allowDeselect={false} value={collection} data={[{ value: EVERY, label: "Every collection" }, ...collections.map((one) => one.name)]} onChange={(value) => setCollection(value ?? EVERY)} />
        <NumberInput label="Share of them" suffix=" %" min={1} max={100} value={percent} onChange={(value) => setPercent(Number(value) || 10)} />
      </Group>
      <Checkbox label="Only of those that somebody has decided about" checked={onlyDecided} onChange={(event) => setOnlyDecided(event.currentTarget.checked)} />
    </FormDialog>
  );
}

/** How people agree who judged the same registrations blindly, and how fast everybody is today. */
export default function ReviewAgreementPage() {
  useTitle("Agreement of curators");
  const [address, setAddress] = useSearchParams();
  const collection = address.get("collection") ?? undefined;
  const collections = useScanCollections().data ?? [];
  const { data, error, refetch } = useReviewAgreement(collection);
  const throughput = useThroughput().data;
  const [isAsking, asking] = useDisclosure(false);
  if (error && !data) return <Failure what="The agreement could not be loaded" error={error} safe="Every decision is untouched." onRetry={() => void refetch()} />;
  return (
    <div className="page">
      <Group justify="space-between" mb="lg" wrap="nowrap">
        <Title order={1}>Agreement of curators</Title>
        <Group gap="sm" wrap="nowrap">
          {collections.length > 1 && (
            <Select
              aria-label="Collection"
              w={220}
              allowDeselect={false}
              value={collection ?? EVERY}
              data={[{ value: EVERY, label: "Every collection" }, ...collections.map((one) => one.name)]}
              onChange={(value) => setAddress(value ? { collection: value } : {}, { replace: true })}
            />
          )}
          <For role="lead">
            <Button variant="default" onClick={asking.open}>
              Ask for second reviews …
            </Button>
          </For>
          <Button component={Link} to="/curate?queue=second" variant={data && data.waiting === 0 ? "default" : "filled"} leftSection={<IconChecks size={16} aria-hidden />}>
            Review blindly
          </Button>
        </Group>
      </Group>
      {!data && <Skeleton h={320} role="status" aria-label="Loading" />}
      {data && (
        <Stack gap="xl">
          <SimpleGrid cols={{ base: 2, md: 4 }}>
            <Fact label="Judged by two, blindly">{data.both.toLocaleString("en")}</Fact>
            <Fact label="Decided alike">{share(data.share_agreed)}</Fact>
            <Fact label="Cohen’s kappa">{formatNumber(data.kappa, 2)}</Fact>
            <Fact label="Still wait for a second person">{data.waiting.toLocaleString("en")}</Fact>
          </SimpleGrid>
          {data.pairs.length === 0 ? (
            <EmptyState icon={<IconUsers size={48} stroke={1.25} />} title="Nobody has reviewed blindly yet">
              A lead asks for second reviews; then another person finds them in the queue “Second review” and decides without seeing the first decision. How well people agree is shown here.
            </EmptyState>
          ) : (
            <div className={classes.pairs}>
              {data.pairs.map((pair) => (
                <PairTable key={`${pair.first_id}/${pair.second_id}`} pair={pair} />
              ))}
            </div>
          )}
          {data.disputed.length > 0 && (
            <section aria-label="Decided otherwise">
              <Title order={2} mb="sm">
                Where they differ
              </Title>
              <Group gap={8}>
                {data.disputed.slice(0, 40).map((id, at) => (
                  <Button key={id} size="compact-xs" variant="default" component={Link} to={`/curate?queue=all&registration=${id}`}>
                    Open no. {at + 1}
                  </Button>
                ))}
                {data.disputed.length > 40 && <Text size="xs" className="quiet">and {data.disputed.length - 40} more</Text>}
              </Group>
            </section>
          )}
          {throughput && throughput.people.length > 0 && (
            <section aria-label="Today">
              <Title order={2} mb="sm">
                Today
              </Title>
              <div className="card" style={{ overflow: "hidden" }}>
                <Table verticalSpacing="xs" horizontalSpacing="md">
                  <Table.Thead>
                    <Table.Tr>
                      <Table.Th>Person</Table.Th>
                      {["Decisions", "Accepted", "Rejected", "Unsure", "Taken back", "Active minutes", "A minute"].map((name) => (
                        <Table.Th key={name} ta="right">
                          {name}
                        </Table.Th>
                      ))}
                    </Table.Tr>
                  </Table.Thead>
                  <Table.Tbody>
                    {throughput.people.map((one) => (
                      <Table.Tr key={one.account_id}>
                        <Table.Td>{one.name}</Table.Td>
                        {[one.decisions, one.accept, one.reject, one.unsure, one.undone].map((count, at) => (
                          <Table.Td key={at} ta="right">
                            {count.toLocaleString("en")}
                          </Table.Td>
                        ))}
                        <Table.Td ta="right">{formatNumber(one.active_minutes, 0)}</Table.Td>
                        <Table.Td ta="right">{formatNumber(one.per_minute, 0)}</Table.Td>
                      </Table.Tr>
                    ))}
                  </Table.Tbody>
                </Table>
              </div>
            </section>
          )}
        </Stack>
      )}
      <AskDialog isOpen={isAsking} onClose={asking.close} />
    </div>
  );
}
