/** The only file that talks to the network. */

import { whileShown } from "./whileShown";

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

/** Stands at the way out: says in whose name requests go, and who has to log in before one can be tried again. */
export interface Doorkeeper {
  /** Whose page this is; the server refuses a request when somebody else is logged in by now. */
  account: () => string | null;
  /** How often somebody has logged in here: a refusal from before the last time says nothing about now. */
  loginCount: () => number;
  /** A request was refused because nobody is logged in. */
  report: (failure: ApiError) => void;
  /** Resolves when the same person is logged in again; rejects when `signal` aborts. */
  wait: (signal?: AbortSignal) => Promise<void>;
}

let doorkeeper: Doorkeeper | null = null;
export const setDoorkeeper = (keeper: Doorkeeper): void => {
  doorkeeper = keeper;
};

const ACCOUNT_HEADER = "X-Handloom-Account";

export interface RequestOptions {
  body?: unknown;
  headers?: Record<string, string>;
  /** A list gives its name several times. */
  query?: Record<string, string | number | readonly string[] | undefined | null>;
  signal?: AbortSignal;
  /** What to do when nobody is logged in: wait for the login and try again, or fail at once. */
  whenOut?: "wait" | "fail";
  /** Let the request outlive the page (for good-byes). */
  keepalive?: boolean;
}

export interface Answer<T> {
  data: T;
  headers: Headers;
}

const unreachable = (): ApiError =>
  new ApiError(0, "Unreachable", "The studio does not answer. Check this computer's network; if it is up, ask whoever runs the studio whether it still runs.");

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

const isLoggingIn = (address: string): boolean => address.startsWith(`${API}/login`);

async function send(method: string, address: string, options: RequestOptions, body?: BodyInit): Promise<Response> {
  let response: Response;
  const account = doorkeeper?.account();
  const loginCount = doorkeeper?.loginCount();
  try {
    response = await fetch(address, {
      method,
      body: body ?? null,
      headers: { ...options.headers, ...(account ? { [ACCOUNT_HEADER]: account } : {}) },
      signal: options.signal ?? null,
      keepalive: options.keepalive ?? false,
    });
  } catch (failure) {
    if (options.signal?.aborted) throw failure;
    throw unreachable();
  }
  if (response.ok) return response;
  const failure = parseFailure(response.status, await response.text());
  if (failure.status !== 401 || !doorkeeper || isLoggingIn(address)) throw failure;
  if (doorkeeper.loginCount() !== loginCount) return send(method, address, options, body);
  doorkeeper.report(failure);
  if (options.whenOut === "fail" || options.keepalive) throw failure;
  await doorkeeper.wait(options.signal);
  return send(method, address, options, body);
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

/** Bytes that answer a request with a JSON body. */
export async function sendForBytes(method: string, path: string, options: RequestOptions): Promise<ArrayBuffer> {
  const headers = { "Content-Type": "application/json", ...options.headers };
  const response = await send(method, addressOf(path, options.query), { ...options, headers }, JSON.stringify(options.body));
  return response.arrayBuffer();
}

/** Have the browser save bytes as a file. */
export function saveAnswer(data: ArrayBuffer, name: string): void {
  const address = URL.createObjectURL(new Blob([data]));
  const link = Object.assign(document.createElement("a"), { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
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
    const account = doorkeeper?.account();
    if (account) call.setRequestHeader(ACCOUNT_HEADER, account);
    call.upload.onprogress = (event) => event.lengthComputable && onProgress(event.loaded / event.total);
    call.onerror = () => reject(unreachable());
    call.onabort = () => reject(new DOMException("The upload was cancelled.", "AbortError"));
    call.onload = () => {
      if (call.status >= 200 && call.status < 300) return resolve(JSON.parse(call.responseText) as T);
      const failure = parseFailure(call.status, call.responseText);
      if (call.status !== 401 || !doorkeeper) return reject(failure);
      doorkeeper.report(failure);
      doorkeeper.wait(signal).then(() => upload<T>(path, form, onProgress, signal)).then(resolve, reject);
    };
    signal.addEventListener("abort", () => call.abort());
    call.send(form);
  });
}

const REOPEN_MS = 3000;

/**
 * Server-sent events while the page is shown; returns the way to stop. It opens again by itself, after a login too.
 * `address` is asked whenever it is opened, and a handler gets the event's id, by which a stream goes on where it was.
 */
export function listen(
  address: () => string,
  handlers: Record<string, (data: unknown, id: string) => void>,
  onLink: (isUp: boolean) => void = () => undefined,
): () => void {
  let stopping = new AbortController();
  let source: EventSource | undefined;
  const open = (): void => {
    if (stopping.signal.aborted) return;
    const opened = new EventSource(API + address());
    source = opened;
    opened.onopen = () => onLink(true);
    opened.onerror = () => {
      onLink(false);
      // The browser gives up on a refusal without saying which: a plain request finds out, and waits for a login.
      if (opened.readyState === EventSource.CLOSED) void reopen(stopping.signal);
    };
    for (const [event, handle] of Object.entries(handlers)) {
      opened.addEventListener(event, (message) => handle(JSON.parse((message as MessageEvent<string>).data), (message as MessageEvent<string>).lastEventId));
    }
  };
  const reopen = async (signal: AbortSignal): Promise<void> => {
    try {
      await send("GET", `${API}/account`, { signal });
      await new Promise((resolve) => setTimeout(resolve, REOPEN_MS / 3));
    } catch {
      await new Promise((resolve) => setTimeout(resolve, REOPEN_MS));
    }
    if (!signal.aborted) open();
  };
  return whileShown(
    () => {
      stopping = new AbortController();
      open();
    },
    () => {
      stopping.abort();
      source?.close();
    },
  );
}
