/** What the account remembers for the browser app. */

import { requestWithHeaders, request } from "./client";

interface Me {
  preferences: Record<string, unknown>;
}

export const fetchPreferences = async (): Promise<Record<string, unknown>> => (await request<Me>("GET", "/account")).preferences;

/** Change one preference and leave the others as they are, also when another window changes one at the same time. */
export async function storePreference(name: string, value: unknown): Promise<void> {
  for (let tries = 0; ; tries += 1) {
    const { data, headers } = await requestWithHeaders<Me>("GET", "/account");
    try {
      await request("PUT", "/account/preferences", {
        body: { ...data.preferences, [name]: value },
        headers: { "If-Match": headers.get("ETag") ?? "*" },
      });
      return;
    } catch (failure) {
      if (tries === 2) throw failure;
    }
  }
}
