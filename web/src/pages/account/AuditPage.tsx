import { Group, Select, Skeleton, Table, Text, TextInput, Title } from "@mantine/core";
import { useInfiniteQuery } from "@tanstack/react-query";
import { IconHistory } from "@tabler/icons-react";
import { useSearchParams } from "react-router";
import { fetchAudit, usePeople } from "../../api/account";
import { describeAct, describeDetail } from "../../model/audit";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { ShowMore } from "../parts/ShowMore";
import { useTitle } from "../parts/useTitle";
import classes from "./account.module.css";
import { formatMoment } from "./moment";

const UUID = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/i;

const ACTS = ["account", "token", "recording", "track", "job", "batch", "project", "assignment", "labels"];

/** Who did what, and when; annotations have their own history beside the picture. */
export default function AuditPage() {
  useTitle("Audit trail");
  const [address, setAddress] = useSearchParams();
  const filter = {
    account_id: address.get("account_id") ?? undefined,
    act: address.get("act") ?? undefined,
    subject_id: UUID.test(address.get("subject_id") ?? "") ? (address.get("subject_id") ?? undefined) : undefined,
  };
  const people = usePeople().data ?? [];
  const names = new Map(people.map((person) => [person.id, person.name]));
  const list = useInfiniteQuery({
    queryKey: ["audit", filter],
    queryFn: ({ pageParam }) => fetchAudit(filter, pageParam),
    initialPageParam: null as string | null,
    getNextPageParam: (page) => page.next_cursor,
  });
  const put = (name: string, value: string | null): void =>
    setAddress(
      (now) => {
        if (value) now.set(name, value);
        else now.delete(name);
        return now;
      },
      { replace: true },
    );
  const lines = list.data?.pages.flatMap((page) => page.items);
  if (list.error && !lines) return <Failure what="The trail could not be loaded" error={list.error} onRetry={() => void list.refetch()} />;
  return (
    <div className="page">
      <Title order={1} mb="lg">
        Audit trail
      </Title>
      <section className={classes.card}>
        <Group gap="md" mb="md" align="end">
          <Select w={208} label="Who" placeholder="everybody" clearable searchable data={people.map((person) => ({ value: person.id, label: person.name }))} value={filter.account_id ?? null} onChange={(value) => put("account_id", value)} />
          <Select w={176} label="What" placeholder="all acts" clearable data={ACTS} value={filter.act ?? null} onChange={(value) => put("act", value)} />
          <TextInput w={328} label="Which one" placeholder="id of a recording, track, account …" defaultValue={filter.subject_id ?? ""} onChange={(event) => put("subject_id", event.currentTarget.value.trim())} />
        </Group>
        {lines?.length === 0 && (
          <EmptyState icon={<IconHistory size={48} stroke={1.25} />} title="No such entries">
            Logins, changes of accounts, imports, jobs and assignments are listed here. Remove a filter to see more.
          </EmptyState>
        )}
        {!lines && <Skeleton height={240} />}
        {lines && lines.length > 0 && (
          <div className="table-scroll">
            <Table verticalSpacing="xs" highlightOnHover miw={840}>
              <Table.Thead>
                <Table.Tr>
                  <Table.Th w={184}>When</Table.Th>
                  <Table.Th w={160}>Who</Table.Th>
                  <Table.Th w={176}>What</Table.Th>
                  <Table.Th>More</Table.Th>
                </Table.Tr>
              </Table.Thead>
              <Table.Tbody>
                {lines.map((line) => (
                  <Table.Tr key={line.id}>
                    <Table.Td className="one-line">{formatMoment(line.time)}</Table.Td>
                    <Table.Td>{line.account ?? "command line"}</Table.Td>
                    <Table.Td>{describeAct(line.act)}</Table.Td>
                    <Table.Td style={{ overflowWrap: "anywhere" }}>
                      <Text size="sm" component="span">
                        {describeDetail(line.detail, names)}
                      </Text>{" "}
                      {line.subject_id && (
                        <Text size="xs" className="quiet" component="span">
                          {line.subject} {names.get(line.subject_id) ?? line.subject_id.slice(0, 8)}
                        </Text>
                      )}
                    </Table.Td>
                  </Table.Tr>
                ))}
              </Table.Tbody>
            </Table>
          </div>
        )}
        <ShowMore list={list} label="Earlier acts" />
      </section>
    </div>
  );
}
