import { useMemo } from "react";
import { useSearchParams } from "react-router";
import type { Order, Queue, QueueChoice } from "../../api/registrations";

const QUEUES: readonly Queue[] = ["undecided", "flagged", "second", "all"];
const ORDERS: readonly Order[] = ["likely_failures", "newest"];

/** The address holds which queue one is in, so that a link brings a colleague to the same one. */
export function useQueueAddress(): readonly [QueueChoice, (patch: Partial<QueueChoice>) => void, string | null] {
  const [address, setAddress] = useSearchParams();
  const [queue, order, collection, model] = ["queue", "order", "collection", "model"].map((name) => address.get(name));
  const choice = useMemo<QueueChoice>(
    () => ({
      queue: QUEUES.find((one) => one === queue) ?? "undecided",
      order: ORDERS.find((one) => one === order) ?? "likely_failures",
      ...(collection ? { collection } : {}),
      ...(model ? { model_id: model } : {}),
    }),
    [queue, order, collection, model],
  );
  const change = (patch: Partial<QueueChoice>): void => {
    const next = { ...choice, ...patch };
    const entries = Object.entries({
      queue: next.queue === "undecided" ? undefined : next.queue,
      order: next.order === "likely_failures" ? undefined : next.order,
      collection: next.collection,
      model: next.model_id,
    }).filter((entry): entry is [string, string] => Boolean(entry[1]));
    setAddress(Object.fromEntries(entries), { replace: true });
  };
  return [choice, change, address.get("registration")] as const;
}
