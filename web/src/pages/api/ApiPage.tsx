import { Accordion, Anchor, Badge, Code, Group, Skeleton, Stack, Table, Text, TextInput, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { request } from "../../api/client";
import { Failure } from "../parts/Failure";
import { useTitle } from "../parts/useTitle";
import { describeSchema, groupOperations, schemaName, type ApiDocument, type Operation } from "./document";

/** Reading is calm, adding and changing stand out, deleting most of all; the word says it too. */
const COLORS: Readonly<Record<string, string>> = { GET: "gray", POST: "teal", PUT: "teal", PATCH: "teal", DELETE: "red" };

/** Every request of the studio's API, from the document that the server itself gives. */
export default function ApiPage() {
  useTitle("API");
  const [words, setWords] = useState("");
  const { data, error, refetch } = useQuery({ queryKey: ["openapi"], queryFn: ({ signal }) => request<ApiDocument>("GET", "/openapi.json", { signal }), staleTime: Infinity });
  if (error && !data) return <Failure what="The API's document could not be loaded" error={error} onRetry={() => void refetch()} />;
  const groups = data ? groupOperations(data, words) : [];
  return (
    <div className="page">
      <Title order={1} mb={4}>
        API
      </Title>
      <Text className="quiet" mb="md">
        Everything that this app does, scripts can do too. Tokens for scripts are made on the page of your account. The whole contract:{" "}
        <Anchor href="/api/v1/openapi.json" target="_blank">
          openapi.json
        </Anchor>
      </Text>
      <TextInput label="Find a request" placeholder="words of its address or of what it does" value={words} onChange={(event) => setWords(event.currentTarget.value)} mb="lg" maw={480} />
      {!data && <Skeleton h={480} />}
      {data && groups.length === 0 && <Text>No request holds these words.</Text>}
      <Stack gap="xl">
        {groups.map(([tag, operations]) => (
          <section key={tag} aria-label={tag}>
            <Title order={2} mb="xs">
              {tag[0]?.toUpperCase()}
              {tag.slice(1)}
            </Title>
            <Accordion variant="separated" multiple>
              {operations.map((operation) => (
                <Accordion.Item key={operation.operationId} value={operation.operationId}>
                  <Accordion.Control>
                    <Group gap="md" wrap="nowrap" align="center">
                      <Badge variant="outline" radius="sm" w={72} color={COLORS[operation.method] ?? "gray"} style={{ flexShrink: 0 }}>
                        {operation.method}
                      </Badge>
                      <div style={{ minWidth: 0, overflowWrap: "anywhere" }}>
                        <Text ff="monospace" size="sm">
                          {operation.path}
                        </Text>
                        <Text size="sm" className="quiet">
                          <Words text={operation.description?.split("\n")[0]} />
                        </Text>
                      </div>
                    </Group>
                  </Accordion.Control>
                  <Accordion.Panel>
                    <Details operation={operation} document={data as ApiDocument} />
                  </Accordion.Panel>
                </Accordion.Item>
              ))}
            </Accordion>
          </section>
        ))}
      </Stack>
    </div>
  );
}

/** The document's words; what stands between backticks is code. */
function Words({ text = "" }: { text?: string | undefined }) {
  return text.split("`").map((part, place) => (place % 2 ? <Code key={place}>{part}</Code> : part));
}

function Details({ operation, document }: { operation: Operation; document: ApiDocument }) {
  const bodies = Object.entries(operation.requestBody?.content ?? {});
  return (
    <Stack gap="md">
      {operation.description?.includes("\n") && <Text size="sm"><Words text={operation.description.split("\n").slice(1).join(" ").trim()} /></Text>}
      {(operation.parameters?.length ?? 0) > 0 && (
        <Table>
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Parameter</Table.Th>
              <Table.Th>Stands in</Table.Th>
              <Table.Th>Is</Table.Th>
              <Table.Th>Means</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {operation.parameters?.map((parameter) => (
              <Table.Tr key={`${parameter.in} ${parameter.name}`}>
                <Table.Td>
                  <Code>{parameter.name}</Code>
                  {parameter.required ? "" : " (optional)"}
                </Table.Td>
                <Table.Td>{parameter.in}</Table.Td>
                <Table.Td>{describeSchema(parameter.schema)}</Table.Td>
                <Table.Td>
                  <Words text={parameter.description} />
                </Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      )}
      {bodies.map(([kind, { schema }]) => (
        <Schema key={kind} title={`Body, ${kind}`} schema={schema} document={document} />
      ))}
      {Object.entries(operation.responses).map(([status, { description, content }]) =>
        status.startsWith("2") ? <Schema key={status} title={`Answer ${status}: ${description}`} schema={Object.values(content ?? {})[0]?.schema} document={document} /> : null,
      )}
      <Text size="sm" className="quiet">
        Otherwise: {Object.keys(operation.responses).filter((status) => !status.startsWith("2")).join(", ")}, each with <Code>error</Code> and <Code>detail</Code>.
      </Text>
    </Stack>
  );
}

function Schema({ title, schema, document }: { title: string; schema: object | undefined; document: ApiDocument }) {
  const name = schemaName(schema);
  const shown = (name && document.components.schemas[name]) ?? schema;
  return (
    <div>
      <Text size="sm" fw={600} mb={4}>
        {title}
        {name ? ` (${name})` : ""}
      </Text>
      {shown && Object.keys(shown).length > 0 && (
        <Code block mah={320} style={{ overflow: "auto" }} tabIndex={0}>
          {JSON.stringify(shown, null, 2)}
        </Code>
      )}
    </div>
  );
}
