/** The studio's own OpenAPI document, as far as the page of the API shows it. */

export interface Parameter {
  readonly name: string;
  readonly in: string;
  readonly required?: boolean;
  readonly description?: string;
  readonly schema: object;
}

type Content = Readonly<Record<string, { readonly schema?: object }>>;

export interface Operation {
  readonly method: string;
  readonly path: string;
  readonly operationId: string;
  readonly description?: string;
  readonly tags?: readonly string[];
  readonly parameters?: readonly Parameter[];
  readonly requestBody?: { readonly content: Content };
  readonly responses: Readonly<Record<string, { readonly description: string; readonly content?: Content }>>;
}

export interface ApiDocument {
  readonly info: { readonly title: string; readonly version: string };
  readonly paths: Readonly<Record<string, Readonly<Record<string, Omit<Operation, "method" | "path">>>>>;
  readonly components: { readonly schemas: Readonly<Record<string, object>> };
}

/** Requests under the name of what they are about, in the document's order; only those that hold every word. */
export function groupOperations(document: ApiDocument, words: string): [string, Operation[]][] {
  const wanted = words.toLowerCase().split(/\s+/);
  const groups = new Map<string, Operation[]>();
  for (const [path, item] of Object.entries(document.paths))
    for (const [method, operation] of Object.entries(item)) {
      const text = `${method} ${path} ${operation.description ?? ""}`.toLowerCase();
      if (!wanted.every((word) => text.includes(word))) continue;
      const tag = operation.tags?.[0] ?? "other";
      groups.set(tag, [...(groups.get(tag) ?? []), { ...operation, method: method.toUpperCase(), path }]);
    }
  return [...groups];
}

/** The name of the schema that a place refers to, if it has one. */
export const schemaName = (schema: object | undefined): string | null => {
  const found = JSON.stringify(schema ?? {}).match(/"#\/components\/schemas\/([^"]+)"/);
  return found?.[1] ?? null;
};

/** A schema in few words: its type, or the names of what it is made of. */
export function describeSchema(schema: object): string {
  const { type, format, anyOf, enum: values, items, $ref } = schema as { type?: string; format?: string; anyOf?: object[]; enum?: unknown[]; items?: object; $ref?: string };
  if ($ref) return $ref.split("/").at(-1) ?? "";
  if (values) return values.map((value) => JSON.stringify(value)).join(" | ");
  if (anyOf) return anyOf.map(describeSchema).join(" | ");
  if (type === "array" && items) return `list of ${describeSchema(items)}`;
  return [type ?? "any", format].filter(Boolean).join(", ");
}
