import { Alert, Button, PasswordInput, Stack, TextInput } from "@mantine/core";
import { useState, type FormEvent } from "react";
import { logIn, logInWithCode } from "../../api/account";
import { ApiError } from "../../api/client";
import type { Me } from "../../api/types";

const describe = (failure: unknown): string => (failure instanceof ApiError ? failure.detail : String(failure));

function useSending(send: () => Promise<Me>, onIn: (me: Me) => void) {
  const [isSending, setSending] = useState(false);
  const [failure, setFailure] = useState<string | null>(null);
  const submit = (event: FormEvent): void => {
    event.preventDefault();
    setSending(true);
    setFailure(null);
    send()
      .then(onIn, (reason: unknown) => setFailure(describe(reason)))
      .finally(() => setSending(false));
  };
  return { isSending, failure, setFailure, submit };
}

function Refusal({ text }: { text: string | null }) {
  if (!text) return null;
  return (
    <Alert color="red" variant="light" role="alert" p="sm">
      {text}
    </Alert>
  );
}

/** Name and password. `name` is who was here; then only the password is missing. */
export function LoginForm({ name: known = "", onIn }: { name?: string; onIn: (me: Me) => void }) {
  const [name, setName] = useState(known);
  const [password, setPassword] = useState("");
  const { isSending, failure, submit } = useSending(() => logIn(name.trim(), password), onIn);
  return (
    <form onSubmit={submit}>
      <Stack gap="md">
        <TextInput label="Name" name="username" autoComplete="username" value={name} onChange={(event) => setName(event.currentTarget.value)} required withAsterisk={false} data-autofocus={known === "" || undefined} autoFocus={known === ""} />
        <PasswordInput label="Password" name="password" autoComplete="current-password" value={password} onChange={(event) => setPassword(event.currentTarget.value)} required withAsterisk={false} data-autofocus={known !== "" || undefined} autoFocus={known !== ""} />
        <Refusal text={failure} />
        <Button type="submit" loading={isSending} fullWidth>
          Log in
        </Button>
      </Stack>
    </form>
  );
}

/** A one-time code is in the address; what is missing is the password that it sets. */
export function CodeForm({ code, onIn }: { code: string; onIn: (me: Me) => void }) {
  const [password, setPassword] = useState("");
  const [again, setAgain] = useState("");
  const { isSending, failure, setFailure, submit } = useSending(() => logInWithCode(code, password), onIn);
  const check = (event: FormEvent): void => {
    if (password === again) return submit(event);
    event.preventDefault();
    setFailure("The two passwords differ.");
  };
  return (
    <form onSubmit={check}>
      <Stack gap="md">
        <PasswordInput label="New password" description="At least 10 characters; use several words." name="new-password" autoComplete="new-password" value={password} onChange={(event) => setPassword(event.currentTarget.value)} required withAsterisk={false} autoFocus />
        <PasswordInput label="Again" name="new-password-again" autoComplete="new-password" value={again} onChange={(event) => setAgain(event.currentTarget.value)} required withAsterisk={false} />
        <Refusal text={failure} />
        <Button type="submit" loading={isSending} fullWidth>
          Set password and log in
        </Button>
      </Stack>
    </form>
  );
}
