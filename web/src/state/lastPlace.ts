/** Where this person annotated last, so that "Annotate" leads back there. */

const NAME = "handloom/last-annotated";

export function keepPlace(address: string): void {
  try {
    window.localStorage.setItem(NAME, address);
  } catch {
    // A browser without storage only forgets the place.
  }
}

export const lastPlace = (): string | null => window.localStorage.getItem(NAME);

export const forgetPlace = (): void => window.localStorage.removeItem(NAME);
