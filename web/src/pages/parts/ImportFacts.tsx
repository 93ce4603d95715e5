import { Code, Table, Text, Title } from "@mantine/core";
import type { ImportReport } from "../../api/types";
import { formatName } from "../../model/format";

const HANDLED = new Set(["ok", "problems", "warnings", "options", "name"]);

function show(value: unknown): string {
  if (value === null || value === undefined) return "–";
  if (typeof value === "number") return Number.isInteger(value) ? String(value) : value.toPrecision(6).replace(/\.?0+$/, "");
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value === "string") return value;
  if (Array.isArray(value)) return value.map(show).join(", ");
  return Object.entries(value as Record<string, unknown>)
    .map(([key, held]) => `${formatName(key).toLowerCase()} ${show(held)}`)
    .join(", ");
}

const isTable = (value: unknown): value is Record<string, unknown>[] =>
  Array.isArray(value) && value.length > 0 && value.every((row) => typeof row === "object" && row !== null && !Array.isArray(row));

/** The figures of a report: plain facts as a list, lists of things (cameras) as tables. */
export function ImportFacts({ report }: { report: ImportReport }) {
  const facts = Object.entries(report).filter(([name, value]) => !HANDLED.has(name) && value !== null && !(Array.isArray(value) && value.length === 0));
  const plain = facts.filter(([, value]) => !isTable(value));
  const tables = facts.filter((fact): fact is [string, Record<string, unknown>[]] => isTable(fact[1]));
  return (
    <>
      {tables.map(([name, rows]) => {
        const columns = [...new Set(rows.flatMap((row) => Object.keys(row)))];
        return (
          <section key={name} className="card" style={{ padding: 16, overflowX: "auto" }} aria-label={formatName(name)}>
            <Title order={2} mb="sm">
              {formatName(name)}
            </Title>
            <Table>
              <Table.Tbody>
                {columns.map((column) => (
                  <Table.Tr key={column}>
                    <Table.Th w={200} fw={400} className="quiet">
                      {formatName(column)}
                    </Table.Th>
                    {rows.map((row, index) => (
                      <Table.Td key={index} style={{ overflowWrap: "anywhere" }}>
                        {show(row[column])}
                      </Table.Td>
                    ))}
                  </Table.Tr>
                ))}
              </Table.Tbody>
            </Table>
          </section>
        );
      })}
      {plain.length > 0 && (
        <section className="card" style={{ padding: 16 }} aria-label="Found">
          <Title order={2} mb="sm">
            Found
          </Title>
          <Table>
            <Table.Tbody>
              {plain.map(([name, value]) => (
                <Table.Tr key={name}>
                  <Table.Th w={200} fw={400} className="quiet">
                    {formatName(name)}
                  </Table.Th>
                  <Table.Td style={{ overflowWrap: "anywhere" }}>
                    {typeof value === "object" ? <Code>{show(value)}</Code> : <Text size="sm">{show(value)}</Text>}
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </section>
      )}
    </>
  );
}
