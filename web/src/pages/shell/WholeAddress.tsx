import { Outlet, useMatches } from "react-router";
import { MissingPage } from "./MissingPage";

const ID = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/i;

/** Whether everything that an address names by an id has a whole one: links are cut off by mails and chats. */
export const isWhole = (params: Readonly<Record<string, string | undefined>>): boolean => Object.entries(params).every(([name, value]) => name === "*" || ID.test(value ?? ""));

/** The page of an address, or word that there is none. */
export function WholeAddress() {
  return isWhole(useMatches().at(-1)?.params ?? {}) ? <Outlet /> : <MissingPage />;
}
