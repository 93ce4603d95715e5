import { Badge, Button, Group, Skeleton, Table, Text } from "@mantine/core";
import { useEndLogin, useLogins } from "../../api/account";
import { formatMoment } from "./moment";
import { Failure } from "../parts/Failure";

/** "Firefox on Linux" of a browser's long name for itself. */
export function describeBrowser(agent: string): string {
  const browser = /Edg\//.test(agent) ? "Edge" : /Firefox\//.test(agent) ? "Firefox" : /Chrom(e|ium)\//.test(agent) ? "Chrome" : /Safari\//.test(agent) ? "Safari" : agent.slice(0, 40) || "Unknown browser";
  const system = /Windows/.test(agent) ? "Windows" : /Android/.test(agent) ? "Android" : /iPhone|iPad/.test(agent) ? "iOS" : /Mac OS/.test(agent) ? "macOS" : /Linux/.test(agent) ? "Linux" : "";
  return system ? `${browser} on ${system}` : browser;
}

export function Logins() {
  const { data, error, refetch } = useLogins();
  const end = useEndLogin();
  if (error && !data) return <Failure what="Your logins could not be loaded" error={error} onRetry={() => void refetch()} />;
  if (!data) return <Skeleton height={96} />;
  return (
    <div className="table-scroll">
      <Table miw={520} verticalSpacing="sm">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Browser</Table.Th>
            <Table.Th>Since</Table.Th>
            <Table.Th>Last seen</Table.Th>
            <Table.Th />
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {data.map((login) => (
            <Table.Tr key={login.id}>
              <Table.Td>
                <Group gap="sm">
                  {describeBrowser(login.user_agent)}
                  {login.is_this && (
                    <Badge variant="light" tt="none">
                      this one
                    </Badge>
                  )}
                </Group>
              </Table.Td>
              <Table.Td>{formatMoment(login.created_at)}</Table.Td>
              <Table.Td>{formatMoment(login.last_seen_at)}</Table.Td>
              <Table.Td ta="right">
                {!login.is_this && (
                  <Button size="xs" variant="default" onClick={() => end.mutate(login.id)}>
                    Log out there
                  </Button>
                )}
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
        {end.error && <caption>{<Text c="var(--bad-text)">{end.error.message}</Text>}</caption>}
      </Table>
    </div>
  );
}
