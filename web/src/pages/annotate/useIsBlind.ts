import { useSearchParams } from "react-router";

/** Whether this is a blind version of the labels: nothing is said there of others' labels or by machines, for people are compared. */
export const useIsBlind = (): boolean => useSearchParams()[0].has("replica");
