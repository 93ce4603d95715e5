import { Button, Group, Skeleton, Text } from "@mantine/core";
import { IconEyeCheck } from "@tabler/icons-react";
import { Link } from "react-router";
import { useFramesToLookAt } from "../../api/framesToLookAt";
import type { QueuePage, Recording } from "../../api/types";
import { formatCount } from "../../model/format";
import { isDoubtful } from "../../model/lookAt";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import classes from "./LabelCheck.module.css";
import { LookItem } from "./LookItem";

/** While the recording, and then its queue, are on their way. */
export function Looking() {
  return (
    <div className={classes.grid} role="status" aria-label="Looking for frames that need a person">
      {Array.from({ length: 8 }, (_, index) => (
        <Skeleton key={index} height={292} radius="lg" />
      ))}
    </div>
  );
}

/** The hands of a recording that most need a person, labelled or not, the worst first. */
export function FramesToLookAt({ recording }: { recording: Recording }) {
  const pages = useFramesToLookAt(recording.id);
  const first = pages.data?.pages[0];
  if (pages.error && !first) {
    return <Failure what="The frames to look at could not be loaded" error={pages.error} safe="Labels are as they were." onRetry={() => void pages.refetch()} />;
  }
  if (!first) return <Looking />;
  if (first.hands === 0) {
    return (
      <EmptyState
        icon={<IconEyeCheck size={48} stroke={1.25} />}
        title="The queue is empty"
        action={
          <Button variant="default" component={Link} to={`/recordings/${recording.id}`}>
            Track it, or find its hands
          </Button>
        }
      >
        Frames are put in order by how well a track, the hand detector and labels agree. A hand that a person placed leaves the queue unless the label check finds something. {first.missing.join(" ")}
      </EmptyState>
    );
  }
  const items = pages.data?.pages.flatMap((page) => page.items) ?? [];
  const [doubtful, others] = [items.filter(isDoubtful), items.filter((item) => !isDoubtful(item))];
  return (
    <>
      <Told page={first} />
      {doubtful.length > 0 && <Items recording={recording} items={doubtful} label="Frames to look at" />}
      {others.length > 0 && (
        <>
          <Text size="sm" className="quiet" my="md">
            From here on no check finds a doubt.
          </Text>
          <Items recording={recording} items={others} label="Frames in which nothing looks wrong" />
        </>
      )}
      {pages.hasNextPage && (
        <Group justify="center" mt="md">
          <Button variant="default" loading={pages.isFetchingNextPage} onClick={() => void pages.fetchNextPage()}>
            Show more of {formatCount(first.hands, "hand")}
          </Button>
        </Group>
      )}
    </>
  );
}

function Items({ recording, items, label }: { recording: Recording; items: QueuePage["items"]; label: string }) {
  return (
    <ul className={classes.grid} aria-label={label}>
      {items.map((item) => (
        <LookItem key={`${item.frame}|${item.hand}`} recording={recording} item={item} />
      ))}
    </ul>
  );
}

/** How many look wrong, by what, and what could not be asked. */
function Told({ page }: { page: QueuePage }) {
  return (
    <div className={classes.told}>
      <Text size="sm">
        {page.doubtful === 0 ? "Nothing looks wrong" : `${formatCount(page.doubtful, "hand")} of ${page.hands} to look at`}
        {page.track ? `; suggestions are those of ${page.track}` : ""}.
      </Text>
      {page.missing.map((sentence) => (
        <Text key={sentence} size="xs" className="quiet">
          {sentence}
        </Text>
      ))}
      {page.is_behind && (
        <Text size="xs" c="var(--warn-text)" role="status">
          Labels have changed since. They are checked again in a moment.
        </Text>
      )}
    </div>
  );
}
