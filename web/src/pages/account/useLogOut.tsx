import { Text } from "@mantine/core";
import { FormDialog } from "../parts/Dialog";
import { useDisclosure } from "@mantine/hooks";
import { notifications } from "@mantine/notifications";
import { useState, type ReactNode } from "react";
import { logOut } from "../../api/account";
import { ApiError } from "../../api/client";
import { formatCount } from "../../model/format";
import { useElsewhere, type Own } from "../../state/elsewhere";

/** No page's status counts anything: whatever waits is found. */
const NOTHING: Own = { scope: "" };

interface LeaveProps {
  isOpen: boolean;
  isLeaving: boolean;
  onStay: () => void;
  onLeave: () => void;
}

/** What is not on the server yet, while it is on its way. */
function LeaveDialog({ isOpen, isLeaving, onStay, onLeave }: LeaveProps) {
  const { mine, crops } = useElsewhere(NOTHING);
  const isSaved = mine === 0 && crops === 0;
  return (
    <FormDialog title="Log out" size={440} isOpen={isOpen} onClose={onStay} onSubmit={onLeave} verb={isSaved ? "Log out" : "Log out anyway"} stay="Stay" isGrave={!isSaved} isBusy={isLeaving}>
      {mine > 0 && (
        <Text size="sm">
          {formatCount(mine, "change")} of yours {mine === 1 ? "is" : "are"} not on the server yet. {mine === 1 ? "It stays" : "They stay"} in this browser and {mine === 1 ? "is" : "are"} sent when you log in here again; nobody else sees{" "}
          {mine === 1 ? "it" : "them"} before.
        </Text>
      )}
      {crops > 0 && (
        <Text size="sm">
          {formatCount(crops, "crop")} {crops === 1 ? "is" : "are"} not saved; {crops === 1 ? "it is" : "they are"} kept in this tab until it is closed.
        </Text>
      )}
      {isSaved && <Text size="sm">Everything is on the server now.</Text>}
    </FormDialog>
  );
}

/** Log out, after a question when something waits. Who could not be logged out stays on the page and is told so. */
export function useLogOut(isEverywhere = false): { ask: () => void; isLeaving: boolean; question: ReactNode } {
  const { mine, crops } = useElsewhere(NOTHING);
  const [isAsking, asking] = useDisclosure(false);
  const [isLeaving, setLeaving] = useState(false);
  const goOut = (): void => window.location.assign("/");
  const leave = (): void => {
    setLeaving(true);
    logOut(isEverywhere).then(goOut, (failure: Error) => {
      if (failure instanceof ApiError && failure.status === 401) return goOut();
      setLeaving(false);
      notifications.show({ color: "red", title: "You are still logged in", message: failure.message });
    });
  };
  return {
    ask: () => (mine + crops > 0 ? asking.open() : leave()),
    isLeaving,
    question: <LeaveDialog isOpen={isAsking} isLeaving={isLeaving} onStay={asking.close} onLeave={leave} />,
  };
}
