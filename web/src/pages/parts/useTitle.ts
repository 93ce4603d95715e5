import { useEffect } from "react";

/** The tab's title says what is open, so that several tabs can be told apart. */
export function useTitle(title: string | undefined): void {
  useEffect(() => {
    document.title = title ? `${title} · Handloom` : "Handloom";
  }, [title]);
}
