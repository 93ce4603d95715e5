const FORMAT = new Intl.DateTimeFormat(undefined, { dateStyle: "medium", timeStyle: "short" });

/** A moment of the API in this person's zone; a dash when there was none. */
export const formatMoment = (moment: string | null): string => (moment ? FORMAT.format(new Date(moment)) : "–");
