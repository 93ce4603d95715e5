import { useMemo } from "react";
import { useSearchParams } from "react-router";
import type { ScanFilters } from "../../api/scans";

const NAMES = ["collection", "subject", "side", "state", "search"] as const;

/** The address holds what the list is narrowed to. */
export function useScanAddress(): readonly [ScanFilters, (patch: Partial<ScanFilters>) => void] {
  const [address, setAddress] = useSearchParams();
  const text = address.toString();
  const filters = useMemo(() => {
    const query = new URLSearchParams(text);
    return Object.fromEntries(NAMES.flatMap((name) => (query.get(name) ? [[name, query.get(name)]] : [])));
  }, [text]);
  const change = (patch: Partial<ScanFilters>): void => {
    const entries = Object.entries({ ...filters, ...patch }).filter((entry): entry is [string, string] => Boolean(entry[1]));
    setAddress(Object.fromEntries(entries), { replace: true });
  };
  return [filters, change] as const;
}
