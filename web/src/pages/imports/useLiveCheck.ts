import { useDebouncedValue } from "@mantine/hooks";
import { useEffect, useState } from "react";
import { useCheckAgain, type ImportOptions } from "../../api/imports";
import type { Import } from "../../api/types";
import { optionsKey, toOptions, type Draft } from "../../model/importForm";

const PAUSE_MS = 400;

/** The fields of an import, and the server's word on them: looked at again shortly after they change, one look at a time. */
export function useLiveCheck(checked: Import) {
  const [draft, setDraft] = useState<Draft>(checked.options as Draft);
  const [refused, setRefused] = useState<string | null>(null);
  const again = useCheckAgain(checked.id);
  const options = toOptions(draft);
  const key = optionsKey(options);
  const isBehind = key !== optionsKey(checked.options as ImportOptions);
  const [settled] = useDebouncedValue(key, PAUSE_MS);
  const { mutate, isPending } = again;
  const mayLook = isBehind && settled === key && !isPending && refused !== key;
  useEffect(() => {
    if (mayLook) mutate(toOptions(draft), { onError: () => setRefused(optionsKey(toOptions(draft))) });
  }, [mayLook, draft, mutate]);
  return {
    draft,
    set: (change: Draft): void => setDraft((now) => ({ ...now, ...change })),
    options,
    /** The report is not yet about what the fields say. */
    isBehind,
    failure: refused === key ? again.error : null,
    retry: (): void => setRefused(null),
  };
}

export type LiveCheck = ReturnType<typeof useLiveCheck>;
