import { useEffect, useRef } from "react";
import { useLocation, useSearchParams } from "react-router";

/**
 * Writes what is in view into the address, a moment after it was last changed, and tells of it. Other entries stay.
 * Never once the person has left: the old page may still be drawn then, and writing would call them back.
 */
export function useLateAddress(entries: Readonly<Record<string, string>>, afterMs: number, onWritten?: (path: string) => void): void {
  const { pathname } = useLocation();
  const [, setAddress] = useSearchParams();
  const written = useRef(onWritten);
  written.current = onWritten;
  const text = JSON.stringify(entries);

  useEffect(() => {
    const timer = setTimeout(() => {
      if (window.location.pathname !== pathname) return;
      const address = new URLSearchParams(window.location.search);
      for (const [name, value] of Object.entries(JSON.parse(text) as Record<string, string>)) address.set(name, value);
      setAddress(address, { replace: true });
      written.current?.(`${pathname}?${address}`);
    }, afterMs);
    return () => clearTimeout(timer);
  }, [text, pathname, afterMs, setAddress]);
}
