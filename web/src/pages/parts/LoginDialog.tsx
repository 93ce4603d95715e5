import { Anchor, Text } from "@mantine/core";
import { Dialog } from "./Dialog";
import type { Me } from "../../api/types";
import { welcome } from "../../state/me";
import { LoginForm } from "./LoginForm";

/** Over the page, which stays as it is: what was done in it is kept and saved as soon as the same person is back. */
export function LoginDialog({ me, isOther }: { me: Me; isOther: boolean }) {
  return (
    <Dialog title={isOther ? "Somebody else is logged in" : "Your login has ended"} size={440}>
      <Text size="sm" mb="md">
        {isOther ? (
          <>
            In another tab of this browser somebody else has logged in. This page is still {me.name}’s: log in as {me.name} to go on, or{" "}
            <Anchor component="button" type="button" inherit onClick={() => window.location.reload()}>
              load it as the other person
            </Anchor>
            .
          </>
        ) : (
          "Log in to continue where you are."
        )}{" "}
        What you did is kept in this browser for {me.name}, and is saved only under that name.
      </Text>
      <LoginForm name={me.name} onIn={welcome} />
    </Dialog>
  );
}
