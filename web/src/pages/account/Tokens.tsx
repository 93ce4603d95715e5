import { Badge, Button, Group, Select, Skeleton, Table, Text, TextInput } from "@mantine/core";
import { useState, type FormEvent } from "react";
import { useAddToken, useRevokeToken, useTokens } from "../../api/account";
import { Failure } from "../parts/Failure";
import { formatMoment } from "./moment";
import { Secret } from "./Secret";

const LIVES = [
  { value: "7", label: "7 days" },
  { value: "90", label: "90 days" },
  { value: "365", label: "a year" },
  { value: "never", label: "no end" },
];

export function Tokens() {
  const { data, error, refetch } = useTokens();
  const [name, setName] = useState("");
  const [access, setAccess] = useState("read");
  const [life, setLife] = useState("90");
  const add = useAddToken();
  const revoke = useRevokeToken();
  const submit = (event: FormEvent): void => {
    event.preventDefault();
    add.mutate({ name, may_write: access === "write", days: life === "never" ? null : Number(life) }, { onSuccess: () => setName("") });
  };
  if (error && !data) return <Failure what="Your tokens could not be loaded" error={error} onRetry={() => void refetch()} />;
  if (!data) return <Skeleton height={96} />;
  const failure = add.error ?? revoke.error;
  return (
    <>
      {add.data && <Secret title="The token is shown this once" text={add.data.secret} onDone={() => add.reset()} />}
      <form onSubmit={submit}>
        <Group align="end" gap="md" mb="md">
          <TextInput w={232} label="What it is for" placeholder="nightly export" value={name} onChange={(event) => setName(event.currentTarget.value)} required withAsterisk={false} maxLength={200} />
          <Select w={144} label="It may" data={[{ value: "read", label: "only read" }, { value: "write", label: "read and write" }]} value={access} onChange={(value) => setAccess(value ?? "read")} allowDeselect={false} />
          <Select w={120} label="Good for" data={LIVES} value={life} onChange={(value) => setLife(value ?? "90")} allowDeselect={false} />
          <Button type="submit" variant="default" loading={add.isPending}>
            Make token
          </Button>
        </Group>
      </form>
      {failure && (
        <Text size="sm" c="var(--bad-text)" role="alert">
          {failure.message}
        </Text>
      )}
      {data.length > 0 && (
        <div className="table-scroll">
          <Table miw={600} verticalSpacing="sm">
            <Table.Thead>
              <Table.Tr>
                <Table.Th>Token</Table.Th>
                <Table.Th>Access</Table.Th>
                <Table.Th>Last used</Table.Th>
                <Table.Th>Ends</Table.Th>
                <Table.Th />
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {data.map((token) => (
                <Table.Tr key={token.id}>
                  <Table.Td>{token.name}</Table.Td>
                  <Table.Td>
                    <Badge variant="light" color={token.may_write ? "orange" : "gray"} tt="none">
                      {token.may_write ? "reads and writes" : "reads"}
                    </Badge>
                  </Table.Td>
                  <Table.Td>{formatMoment(token.last_used_at)}</Table.Td>
                  <Table.Td>{token.expires_at ? formatMoment(token.expires_at) : "never"}</Table.Td>
                  <Table.Td ta="right">
                    <Button size="xs" variant="default" onClick={() => revoke.mutate(token.id)} aria-label={`Revoke ${token.name}`}>
                      Revoke
                    </Button>
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </div>
      )}
    </>
  );
}
