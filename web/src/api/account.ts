import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { request } from "./client";
import { fetchAll } from "./recordings";
import type { AuditLine, Login, Me, NewToken, OneTimeCode, Page, Person, PersonAdded, Role, Token } from "./types";

export const fetchMe = (): Promise<Me> => request<Me>("GET", "/account", { whenOut: "fail" });

export const logIn = (name: string, password: string): Promise<Me> => request<Me>("POST", "/login", { body: { name, password } });

export const logInWithCode = (code: string, password: string): Promise<Me> =>
  request<Me>("POST", "/login/code", { body: { code, password } });

export const logOut = (isEverywhere = false): Promise<void> => request("POST", isEverywhere ? "/logout/everywhere" : "/logout", { whenOut: "fail" });

const keys = {
  logins: ["account", "logins"] as const,
  tokens: ["account", "tokens"] as const,
  people: ["people"] as const,
  audit: ["audit"] as const,
};

export const useLogins = () =>
  useQuery({ queryKey: keys.logins, queryFn: async () => (await request<Page<Login>>("GET", "/account/logins")).items });

export const useTokens = () =>
  useQuery({ queryKey: keys.tokens, queryFn: async () => (await request<Page<Token>>("GET", "/account/tokens")).items });

export const usePeople = () => useQuery({ queryKey: keys.people, queryFn: () => fetchAll<Person>("/accounts") });

export interface AuditFilter {
  account_id?: string | undefined;
  act?: string | undefined;
  subject_id?: string | undefined;
}

export const fetchAudit = (filter: AuditFilter, cursor: string | null): Promise<Page<AuditLine>> =>
  request("GET", "/audit", { query: { ...filter, cursor, limit: 50 } });

/** A change, after which a list is read again. */
function useChange<Input, Output>(key: readonly string[], change: (input: Input) => Promise<Output>) {
  const client = useQueryClient();
  return useMutation({ mutationFn: change, onSettled: () => client.invalidateQueries({ queryKey: key }) });
}

export const useEndLogin = () => useChange(keys.logins, (id: string) => request("DELETE", `/account/logins/${id}`));

export const useChangePassword = () =>
  useChange(keys.logins, (body: { current: string; new: string }) => request("PUT", "/account/password", { body }));

export const useAddToken = () =>
  useChange(keys.tokens, (body: { name: string; may_write: boolean; days: number | null }) => request<NewToken>("POST", "/account/tokens", { body }));

export const useRevokeToken = () => useChange(keys.tokens, (id: string) => request("DELETE", `/account/tokens/${id}`));

export const useAddPerson = () =>
  useChange(keys.people, (body: { name: string; role: Role }) => request<PersonAdded>("POST", "/accounts", { body }));

export const useChangePerson = () =>
  useChange(keys.people, ({ person, ...body }: { person: Person; role?: Role; is_disabled?: boolean }) =>
    request<Person>("PATCH", `/accounts/${person.id}`, { body, headers: { "If-Match": `"${person.revision}"` } }),
  );

export const useMakeCode = () => useChange(keys.people, (id: string) => request<OneTimeCode>("POST", `/accounts/${id}/code`));
