/** The only file that talks to the network. */

export const API = "/api/v1";

/** An answer that is not a success. `status` 0 means that no answer came at all. */
export class ApiError extends Error {
  override name = "ApiError";

  constructor(
    readonly status: number,
    readonly error: string,
    readonly detail: string,
    readonly body: Record<string, unknown> = {},
  ) {
    super(detail);
  }

  get isOffline(): boolean {
    return this.status === 0 || this.status === 502 || this.status === 503 || this.status === 504;
  }
}

export interface RequestOptions {
  body?: unknown;
  headers?: Record<string, string>;
  /** A list gives its name several times. */
  query?: Record<string, string | number | readonly string[] | undefined | null>;
  signal?: AbortSignal;
  /** Let the request outlive the page (for good-byes). */
  keepalive?: boolean;
}

export interface Answer<T> {
  data: T;
  headers: Headers;
}

const unreachable = (): ApiError =>
  new ApiError(0, "Unreachable", "The studio's server does not answer. Check that `handloom serve` is still running.");

function addressOf(path: string, query: RequestOptions["query"]): string {
  const known = Object.entries(query ?? {}).flatMap(([name, value]) =>
    value === undefined || value === null ? [] : [value].flat().map((one) => [name, String(one)]),
  );
  if (known.length === 0) return API + path;
  return `${API}${path}?${new URLSearchParams(known)}`;
}

function parseFailure(status: number, text: string): ApiError {
  try {
    const body = JSON.parse(text) as Record<string, unknown>;
    const detail = typeof body["detail"] === "string" ? body["detail"] : JSON.stringify(body["detail"] ?? body);
    return new ApiError(status, typeof body["error"] === "string" ? body["error"] : "Error", detail, body);
  } catch {
    return new ApiError(status, "Error", `The server answered with status ${status}.`);
  }
}

async function send(method: string, address: string, options: RequestOptions, body?: BodyInit): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(address, {
      method,
      body: body ?? null,
      headers: options.headers ?? {},
      signal: options.signal ?? null,
      keepalive: options.keepalive ?? false,
    });
  } catch (failure) {
    if (options.signal?.aborted) throw failure;
    throw unreachable();
  }
  if (!response.ok) throw parseFailure(response.status, await response.text());
  return response;
}

/** One JSON request with its answer's headers (for `ETag`). */
export async function requestWithHeaders<T>(method: string, path: string, options: RequestOptions = {}): Promise<Answer<T>> {
  const headers = { Accept: "application/json", ...options.headers };
  const hasBody = options.body !== undefined;
  const response = await send(
    method,
    addressOf(path, options.query),
    { ...options, headers: hasBody ? { "Content-Type": "application/json", ...headers } : headers },
    hasBody ? JSON.stringify(options.body) : undefined,
  );
  const text = await response.text();
  return { data: (text ? JSON.parse(text) : undefined) as T, headers: response.headers };
}

/** One JSON request. */
export async function request<T>(method: string, path: string, options: RequestOptions = {}): Promise<T> {
  return (await requestWithHeaders<T>(method, path, options)).data;
}

/** An image, decoded off the main thread. */
export async function fetchBitmap(address: string, signal?: AbortSignal): Promise<ImageBitmap> {
  const response = await send("GET", address, signal ? { signal } : {});
  return createImageBitmap(await response.blob());
}

/** Bytes with their headers, for raw depth. */
export async function fetchBytes(address: string, signal?: AbortSignal): Promise<Answer<ArrayBuffer>> {
  const response = await send("GET", address, signal ? { signal } : {});
  return { data: await response.arrayBuffer(), headers: response.headers };
}

/** Upload a form; `onProgress` gets the part sent, 0..1 (fetch cannot tell, XMLHttpRequest can). */
export function upload<T>(path: string, form: FormData, onProgress: (part: number) => void, signal: AbortSignal): Promise<T> {
  return new Promise((resolve, reject) => {
    const call = new XMLHttpRequest();
    call.open("POST", API + path);
    call.setRequestHeader("Accept", "application/json");
    call.upload.onprogress = (event) => event.lengthComputable && onProgress(event.loaded / event.total);
    call.onerror = () => reject(unreachable());
    call.onabort = () => reject(new DOMException("The upload was cancelled.", "AbortError"));
    call.onload = () => {
      if (call.status >= 200 && call.status < 300) resolve(JSON.parse(call.responseText) as T);
      else reject(parseFailure(call.status, call.responseText));
    };
    signal.addEventListener("abort", () => call.abort());
    call.send(form);
  });
}

/** Server-sent events of one address; returns the way to stop. The browser reconnects by itself. */
export function listen(
  path: string,
  handlers: Record<string, (data: unknown) => void>,
  onLink: (isUp: boolean) => void = () => undefined,
): () => void {
  const source = new EventSource(API + path);
  source.onopen = () => onLink(true);
  source.onerror = () => onLink(false);
  for (const [event, handle] of Object.entries(handlers)) {
    source.addEventListener(event, (message) => handle(JSON.parse((message as MessageEvent<string>).data)));
  }
  return () => source.close();
}
