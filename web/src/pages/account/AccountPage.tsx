import { Badge, Button, Group, PasswordInput, Stack, Text, Title } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useState, type FormEvent } from "react";
import { useChangePassword } from "../../api/account";
import { useMe } from "../../state/me";
import { useTitle } from "../parts/useTitle";
import classes from "./account.module.css";
import { Logins } from "./Logins";
import { Tokens } from "./Tokens";
import { useLogOut } from "./useLogOut";

function PasswordForm() {
  const [current, setCurrent] = useState("");
  const [next, setNext] = useState("");
  const change = useChangePassword();
  const submit = (event: FormEvent): void => {
    event.preventDefault();
    change.mutate(
      { current, new: next },
      {
        onSuccess: () => {
          setCurrent("");
          setNext("");
          notifications.show({ message: "Password changed. Other browsers must log in again.", color: "teal" });
        },
      },
    );
  };
  return (
    <form onSubmit={submit}>
      <Group align="end" gap="md">
        <PasswordInput w={232} label="Current password" autoComplete="current-password" value={current} onChange={(event) => setCurrent(event.currentTarget.value)} />
        <PasswordInput w={232} label="New, of 10 or more characters" autoComplete="new-password" value={next} onChange={(event) => setNext(event.currentTarget.value)} required withAsterisk={false} />
        <Button type="submit" variant="default" loading={change.isPending}>
          Change password
        </Button>
      </Group>
      {change.error && (
        <Text size="sm" c="var(--bad-text)" mt="sm" role="alert">
          {change.error.message}
        </Text>
      )}
    </form>
  );
}

/** One's own account: password, browsers, tokens. */
export default function AccountPage() {
  useTitle("My account");
  const me = useMe();
  const { ask, isLeaving, question } = useLogOut(true);
  return (
    <div className="page">
      {question}
      <Group gap="md" mb="lg">
        <Title order={1}>{me.name}</Title>
        <Badge variant="light" color="gray" tt="none">
          {me.role}
        </Badge>
      </Group>
      <Stack gap="lg">
        {me.is_login_needed && (
          <section className={classes.card} aria-labelledby="password">
            <Title order={2} id="password" mb="md">
              Password
            </Title>
            <PasswordForm />
          </section>
        )}
        {me.is_login_needed && (
          <section className={classes.card} aria-labelledby="browsers">
            <Group justify="space-between" mb="sm">
              <Title order={2} id="browsers">
                Where you are logged in
              </Title>
              <Button variant="default" loading={isLeaving} onClick={ask}>
                Log out everywhere
              </Button>
            </Group>
            <Logins />
          </section>
        )}
        <section className={classes.card} aria-labelledby="tokens">
          <Title order={2} id="tokens">
            Tokens for scripts
          </Title>
          <Text size="sm" className="quiet" mb="md">
            A script sends one as <code>Authorization: Bearer …</code> and may do what you may do, except manage accounts.
          </Text>
          <Tokens />
        </section>
      </Stack>
    </div>
  );
}
