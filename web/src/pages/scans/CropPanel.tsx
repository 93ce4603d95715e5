import { Button, Checkbox, Group, Stack, Text, Title } from "@mantine/core";
import { formatCount } from "../../model/format";
import { useHint } from "../../state/keys";
import type { Crop } from "./useCrop";

interface CropPanelProps {
  crop: Crop;
  revision: number;
  hasColors: boolean;
}

/** What is left out of the scan, and the way to keep it so. */
export function CropPanel({ crop, revision, hasColors }: CropPanelProps) {
  const hint = useHint();
  const { draft, save } = crop;
  return (
    <section aria-label="Crop">
      <Title order={3} mb={4}>
        Crop
      </Title>
      <Text size="xs" className="quiet" mb="sm">
        A stroke with the knife: a closed one removes what it encloses, an open one what lies beyond it. Removed points are red and dim; the file is not changed.
      </Text>
      <Text size="sm" mb="sm" data-testid="crop-share">
        {draft.cuts.length === 0 && crop.share === 0 ? "Nothing is left out." : `${formatCount(draft.cuts.length, "stroke")}; ${(100 * crop.share).toFixed(1)} % of the points are left out.`}
      </Text>
      {hasColors && (
        <Checkbox
          mb="sm"
          size="xs"
          label="Leave out green points, of a painted object"
          checked={draft.dropsObjects}
          disabled={!crop.isReady}
          onChange={(event) => crop.setDropsObjects(event.currentTarget.checked)}
        />
      )}
      <Group gap="sm">
        <Button size="xs" disabled={!crop.isChanged} loading={save.isPending} onClick={() => crop.store()}>
          {hint("Save", "scan.save")}
        </Button>
        <Button size="xs" variant="default" disabled={draft.cuts.length === 0} onClick={crop.undo}>
          Undo
        </Button>
        <Button size="xs" variant="default" disabled={draft.undone.length === 0} onClick={crop.redo}>
          Redo
        </Button>
        <Button size="xs" variant="default" disabled={!crop.canFlip} onClick={crop.flip}>
          Other side
        </Button>
        <Button size="xs" variant="subtle" disabled={draft.cuts.length === 0} onClick={crop.clear}>
          Whole scan
        </Button>
      </Group>
      {crop.isChanged && !save.error && !crop.isOvertaken && (
        <Text size="xs" className="quiet" mt="sm">
          Not saved yet; kept in this tab.
        </Text>
      )}
      {(save.error || crop.isOvertaken) && !save.isPending && (
        <Stack gap="sm" mt="sm" role="alert">
          <Text size="xs" c="var(--bad-text)" style={{ overflowWrap: "anywhere" }}>
            {crop.isOvertaken ? "Somebody else has cropped this scan meanwhile. Your strokes are kept here until you choose." : `${save.error?.message ?? ""} Your strokes are kept here.`}
          </Text>
          {crop.isOvertaken && (
            <Group gap="sm">
              <Button size="compact-xs" onClick={() => crop.store(revision)}>
                Save mine over it
              </Button>
              <Button size="compact-xs" variant="default" onClick={crop.drop}>
                Take theirs
              </Button>
            </Group>
          )}
        </Stack>
      )}
    </section>
  );
}
