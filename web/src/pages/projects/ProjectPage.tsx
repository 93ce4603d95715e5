import { ActionIcon, Button, Group, Text, TextInput, Title, Tooltip } from "@mantine/core";
import { IconPencil } from "@tabler/icons-react";
import { useState } from "react";
import { Link, useNavigate, useParams } from "react-router";
import { useMe, useProject, useTeamChange, type Project } from "../../api/teams";
import { hasRole } from "../../model/assignment";
import { Failure } from "../parts/Failure";
import { PageSkeleton } from "../parts/PageSkeleton";
import { useTitle } from "../parts/useTitle";
import { offerUndo, tellFailure } from "../parts/undo";
import { ProjectAssignments } from "./ProjectAssignments";
import { ProjectRecordings } from "./ProjectRecordings";
import { ProjectReplicas } from "./ProjectReplicas";

/** One project: its recordings, who marks which frames, and who marks them blindly. */
export default function ProjectPage() {
  const { projectId } = useParams();
  const { data: project, error, refetch } = useProject(projectId);
  const isLead = hasRole(useMe().data, "lead");
  useTitle(project?.name ?? "Project");
  if (error && !project) {
    return (
      <Failure what="This project could not be opened" error={error} safe="Nothing is lost on the server." onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to="/projects">
          To the projects
        </Button>
      </Failure>
    );
  }
  if (!project) return <PageSkeleton />;
  const mayChange = isLead && project.archived_at === null;
  return (
    <div className="page">
      <Head project={project} mayChange={mayChange} isLead={isLead} />
      <ProjectRecordings project={project} mayChange={mayChange} />
      <ProjectAssignments project={project} mayChange={mayChange} />
      <ProjectReplicas project={project} mayChange={mayChange} />
    </div>
  );
}

function Head({ project, mayChange, isLead }: { project: Project; mayChange: boolean; isLead: boolean }) {
  const [draft, setDraft] = useState<{ name: string; description: string } | null>(null);
  const change = useTeamChange<Project>();
  const navigate = useNavigate();
  const path = `/projects/${project.id}`;
  const archive = async (): Promise<void> => {
    await change.mutateAsync({ method: "DELETE", path });
    await navigate("/projects");
    offerUndo(`${project.name} was archived; it is in the bin too.`, async () => {
      await change.mutateAsync({ method: "POST", path: `/bin/project/${project.id}/restore` });
      await navigate(path);
    });
  };
  if (draft) {
    return (
      <form
        onSubmit={(event) => {
          event.preventDefault();
          change.mutate({ method: "PATCH", path, body: draft, revision: project.revision }, { onSuccess: () => setDraft(null), onError: tellFailure });
        }}
      >
        <Group mb="xl" align="flex-end" gap="sm">
          <TextInput label="Name" w={320} maxLength={200} autoFocus value={draft.name} onChange={(event) => setDraft({ ...draft, name: event.currentTarget.value })} />
          <TextInput label="Description" w={480} maxLength={4000} value={draft.description} onChange={(event) => setDraft({ ...draft, description: event.currentTarget.value })} />
          <Button type="submit" loading={change.isPending} disabled={!draft.name.trim()}>
            Keep
          </Button>
          <Button variant="default" onClick={() => setDraft(null)}>
            Cancel
          </Button>
        </Group>
      </form>
    );
  }
  return (
    <Group mb="xl" justify="space-between" align="flex-start" wrap="nowrap">
      <div style={{ minWidth: 0 }}>
        <Group gap="sm" wrap="nowrap">
          <Title order={1} className="few-lines" title={project.name}>
            {project.name}
          </Title>
          {mayChange && (
            <Tooltip label="Rename, describe">
              <ActionIcon aria-label="Rename the project" onClick={() => setDraft({ name: project.name, description: project.description })}>
                <IconPencil size={16} />
              </ActionIcon>
            </Tooltip>
          )}
        </Group>
        <Text className="quiet" style={{ overflowWrap: "anywhere" }}>{project.archived_at ? "Archived. What was accepted in it stays locked." : project.description}</Text>
      </div>
      {mayChange && (
        <Button variant="default" loading={change.isPending} onClick={() => void archive().catch(tellFailure)}>
          Archive
        </Button>
      )}
      {isLead && project.archived_at && (
        <Button loading={change.isPending} onClick={() => change.mutate({ method: "POST", path: `/bin/project/${project.id}/restore` })}>
          Restore
        </Button>
      )}
    </Group>
  );
}
