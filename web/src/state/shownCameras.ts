/** Which cameras' pictures are shown side by side: in the address, and remembered for each recording. */

import { useCallback, useMemo, useState } from "react";
import { useSearchParams } from "react-router";
import { useLocalStorage } from "@mantine/hooks";
import type { Camera, Recording } from "../api/types";

export const MAX_SHOWN = 8;
const SHOWN_AT_FIRST = 4;

/** Those of the address, else those of last time, else the first ones; the active one is always among them. */
export function chooseShown(cameras: readonly string[], address: string | null, remembered: readonly string[], active: string): string[] {
  const known = (names: readonly string[]): string[] => cameras.filter((camera) => names.includes(camera));
  const wanted = [known(address?.split(",") ?? []), known(remembered), cameras.slice(0, SHOWN_AT_FIRST)].find((names) => names.length > 0) ?? [];
  const shown = wanted.slice(0, MAX_SHOWN);
  if (shown.includes(active) || !cameras.includes(active)) return shown;
  // Alone with another one means "this camera": then the active one takes its place.
  return shown.length <= 1 ? [active] : known([...shown.slice(0, MAX_SHOWN - 1), active]);
}

export function useShownCameras(recording: Recording, active: string): [readonly Camera[], (names: readonly string[]) => void] {
  const [address, setAddress] = useSearchParams();
  const [remembered, setRemembered] = useLocalStorage<readonly string[]>({ key: `handloom/cameras/${recording.id}`, defaultValue: [], getInitialValueInEffect: false });
  // The address is read once and follows from then on: it changes later than what is clicked.
  const [chosen, setChosen] = useState(address.get("cameras"));
  const names = chooseShown(recording.cameras.map((camera) => camera.id), chosen, remembered, active).join();
  const shown = useMemo(() => recording.cameras.filter((camera) => names.split(",").includes(camera.id)), [recording.cameras, names]);
  const setShown = useCallback(
    (next: readonly string[]) => {
      if (next.length === 0) return;
      setRemembered(next);
      setChosen(next.join());
      const now = new URLSearchParams(window.location.search);
      now.set("cameras", next.join());
      setAddress(now, { replace: true });
    },
    [setAddress, setRemembered],
  );
  return [shown, setShown];
}
