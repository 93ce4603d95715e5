import type { ReactNode } from "react";
import type { Role } from "../../api/types";
import { hasRole, useMe } from "../../state/me";

/** What only people of a role, or of a higher one, are offered: the server refuses it to others. */
export function For({ role, children }: { role: Role; children: ReactNode }) {
  return hasRole(useMe(), role) ? children : null;
}
