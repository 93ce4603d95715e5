import { useQueryClient } from "@tanstack/react-query";
import { Text, Title } from "@mantine/core";
import { useEffect, useRef, type ReactNode } from "react";
import icon from "../../icon.svg?no-inline";
import type { Me } from "../../api/types";
import { loadKeys } from "../../state/keys";
import { usePresence, welcome } from "../../state/me";
import { flushSaving, resumeSaving } from "../../state/saving";
import { Failure } from "./Failure";
import { LoginDialog } from "./LoginDialog";
import { CodeForm, LoginForm } from "./LoginForm";
import classes from "./LoginGate.module.css";
import { useTitle } from "./useTitle";

/** The code of an address such as `/login?code=...`. */
const codeOfAddress = (): string | null =>
  window.location.pathname === "/login" ? new URLSearchParams(window.location.search).get("code") : null;

function enter(me: Me): void {
  if (window.location.pathname === "/login") window.history.replaceState(null, "", "/recordings");
  welcome(me);
}

function LoginPage({ code }: { code: string | null }) {
  useTitle("Log in");
  return (
    <main className={classes.ground}>
      <div className={classes.card}>
        <div className={classes.brand}>
          <img src={icon} width={40} height={40} alt="" />
          <div>
            <Title order={1}>Handloom</Title>
            <Text size="sm" className="quiet">
              {code ? "Choose your password" : "Log in to go on"}
            </Text>
          </div>
        </div>
        {code ? <CodeForm code={code} onIn={enter} /> : <LoginForm onIn={enter} />}
        <Text size="xs" className="quiet" mt="lg">
          {code ? "The code works once. If it is too old, ask a lead for another." : "No account, or the password forgotten? A lead of your studio sends you a link."}
        </Text>
      </div>
    </main>
  );
}

/** Once it is known who this is: send what waits, and whenever they have come back after a login ended. */
function useReturn(): void {
  const kind = usePresence().kind;
  const client = useQueryClient();
  const wasExpired = useRef<boolean | null>(null);
  useEffect(() => {
    if (kind === "in" && wasExpired.current === null) {
      resumeSaving();
      void loadKeys();
      wasExpired.current = false;
    } else if (kind === "in" && wasExpired.current) {
      flushSaving();
      void client.invalidateQueries();
      // Pictures that were refused meanwhile are asked for again.
      document.querySelectorAll("img").forEach((image) => {
        if (image.complete && image.naturalWidth === 0) image.src = image.getAttribute("src") ?? "";
      });
      wasExpired.current = false;
    } else if (kind === "expired") wasExpired.current = true;
  }, [kind, client]);
}

/** Nothing of the studio is shown before it is known who looks at it; a login that ends later is a dialog over the page. */
export function Gate({ children }: { children: ReactNode }) {
  const presence = usePresence();
  useReturn();
  const code = codeOfAddress();
  if (code !== null || presence.kind === "out") return <LoginPage code={code} />;
  if (presence.kind === "asking") return null;
  if (presence.kind === "away") {
    return <Failure what="The studio does not answer" error={presence.failure} safe="Your work is safe; reconnecting." />;
  }
  return (
    <>
      {children}
      {presence.kind === "expired" && <LoginDialog me={presence.me} isOther={presence.isOther} />}
    </>
  );
}
