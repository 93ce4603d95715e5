import { Badge, Button, Group, Select, Skeleton, Table, Text, TextInput, Title, Tooltip } from "@mantine/core";
import { useState, type FormEvent } from "react";
import { Link } from "react-router";
import { useAddPerson, useChangePerson, useMakeCode, usePeople } from "../../api/account";
import type { Person, Role } from "../../api/types";
import { useMe } from "../../state/me";
import { Failure } from "../parts/Failure";
import { useTitle } from "../parts/useTitle";
import classes from "./account.module.css";
import { formatMoment } from "./moment";
import { Secret } from "./Secret";

const ROLES: { value: Role; label: string }[] = [
  { value: "annotator", label: "annotator" },
  { value: "reviewer", label: "reviewer" },
  { value: "lead", label: "lead" },
  { value: "admin", label: "admin" },
];

const linkOf = (code: string): string => `${window.location.origin}/login?code=${code}`;

function stateOf(person: Person): string {
  if (person.is_local) return "at the studio's machine";
  if (person.is_disabled) return "disabled";
  return person.has_password ? "may log in" : "no password yet";
}

/** Who may log in, and what they may do. */
export default function PeoplePage() {
  useTitle("People");
  const me = useMe();
  const { data, error, refetch } = usePeople();
  const [name, setName] = useState("");
  const [role, setRole] = useState<Role>("annotator");
  const [link, setLink] = useState<{ name: string; code: string } | null>(null);
  const add = useAddPerson();
  const change = useChangePerson();
  const makeCode = useMakeCode();
  const roles = ROLES.filter(({ value }) => me.role === "admin" || value === "annotator" || value === "reviewer");
  const submit = (event: FormEvent): void => {
    event.preventDefault();
    add.mutate(
      { name, role },
      {
        onSuccess: ({ person, code }) => {
          setName("");
          setLink({ name: person.name, code: code.code });
        },
      },
    );
  };
  const failure = add.error ?? change.error ?? makeCode.error;
  if (error && !data) return <Failure what="The people could not be loaded" error={error} onRetry={() => void refetch()} />;
  return (
    <div className="page">
      <Group justify="space-between" mb="lg">
        <Title order={1}>People</Title>
        <Button component={Link} to="/audit" variant="default">
          Audit trail
        </Button>
      </Group>
      <section className={classes.card}>
        {link && <Secret title={`Send this link to ${link.name}. It sets a password, works once and is shown this once.`} text={linkOf(link.code)} onDone={() => setLink(null)} />}
        <form onSubmit={submit}>
          <Group align="end" gap="md" mb="md">
            <TextInput w={232} label="Name" value={name} onChange={(event) => setName(event.currentTarget.value)} required withAsterisk={false} maxLength={80} />
            <Select w={144} label="Role" data={roles} value={role} onChange={(value) => setRole((value ?? "annotator"))} allowDeselect={false} />
            <Button type="submit" loading={add.isPending}>
              Add person
            </Button>
          </Group>
        </form>
        {failure && (
          <Text size="sm" c="var(--bad-text)" mb="sm" role="alert">
            {failure.message}
          </Text>
        )}
        {data ? (
          <div className="table-scroll">
            <Table verticalSpacing="sm" miw={720}>
              <Table.Thead>
                <Table.Tr>
                  <Table.Th miw={160}>Name</Table.Th>
                  <Table.Th>Role</Table.Th>
                  <Table.Th>State</Table.Th>
                  <Table.Th>Last seen</Table.Th>
                  <Table.Th />
                </Table.Tr>
              </Table.Thead>
              <Table.Tbody>
                {data.map((person) => (
                  <Table.Tr key={person.id} className={person.is_disabled ? classes.off : undefined} data-testid={`person-${person.name}`}>
                    <Table.Td>
                      <Group gap="sm" wrap="nowrap" className="keep-line">
                        {person.name}
                        {person.id === me.id && (
                          <Badge variant="light" tt="none" style={{ flex: "none" }}>
                            you
                          </Badge>
                        )}
                      </Group>
                    </Table.Td>
                    <Table.Td>
                      {person.may_manage ? (
                        <Select w={136} size="xs" aria-label={`Role of ${person.name}`} data={roles} value={person.role} onChange={(value) => value && change.mutate({ person, role: value })} allowDeselect={false} />
                      ) : (
                        person.role
                      )}
                    </Table.Td>
                    <Table.Td className="one-line">{stateOf(person)}</Table.Td>
                    <Table.Td className="one-line">{formatMoment(person.last_seen_at)}</Table.Td>
                    <Table.Td>
                      <Group gap="xs" justify="flex-end" wrap="nowrap" className="keep-line">
                        {person.may_manage && !person.is_disabled && (
                          <Tooltip label="A one-time link with which they set a new password">
                            <Button size="xs" variant="default" onClick={() => makeCode.mutate(person.id, { onSuccess: ({ code }) => setLink({ name: person.name, code }) })}>
                              Password link
                            </Button>
                          </Tooltip>
                        )}
                        {person.may_manage && (
                          <Button size="xs" variant="default" onClick={() => change.mutate({ person, is_disabled: !person.is_disabled })} aria-label={`${person.is_disabled ? "Enable" : "Disable"} ${person.name}`}>
                            {person.is_disabled ? "Enable" : "Disable"}
                          </Button>
                        )}
                        <Button size="xs" variant="subtle" color="gray" component={Link} to={`/audit?account_id=${person.id}`}>
                          Acts
                        </Button>
                      </Group>
                    </Table.Td>
                  </Table.Tr>
                ))}
              </Table.Tbody>
            </Table>
          </div>
        ) : (
          <Skeleton height={160} />
        )}
      </section>
    </div>
  );
}
