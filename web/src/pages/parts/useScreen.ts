/** How much room there is. The style sheets have the same widths, written out. */

import { useMediaQuery } from "@mantine/hooks";

const now = { getInitialValueInEffect: false };

/** Too narrow for all rooms in the header. */
export const useIsNarrow = (): boolean => useMediaQuery("(max-width: 1119px)", undefined, now);

/** A phone, or a tablet held upright: one thing below the other. */
export const useIsCompact = (): boolean => useMediaQuery("(max-width: 800px)", undefined, now);

/** Something to touch with: what a finger does has to be said. */
export const useHasFingers = (): boolean => useMediaQuery("(any-pointer: coarse)", undefined, now);
