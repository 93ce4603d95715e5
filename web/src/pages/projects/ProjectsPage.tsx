import { Button, Group, Progress, SegmentedControl, Skeleton, Stack, Text, TextInput, Title } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconUsersGroup } from "@tabler/icons-react";
import { useState } from "react";
import { Link, useNavigate, useSearchParams } from "react-router";
import { useMe, useProjects, useTeamChange, type Project } from "../../api/teams";
import { hasRole } from "../../model/assignment";
import { formatCount } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { useTitle } from "../parts/useTitle";
import { MyWork } from "./MyWork";
import classes from "./projects.module.css";

/** What is mine to do, then every project. `?archived=yes` shows those put away. */
export default function ProjectsPage() {
  useTitle("Projects");
  const [address, setAddress] = useSearchParams();
  const isArchived = address.get("archived") === "yes";
  const { data, error, refetch } = useProjects(isArchived);
  const me = useMe().data;
  const isLead = hasRole(me, "lead");
  if (error && !data) return <Failure what="The projects could not be loaded" error={error} safe="Nothing is lost on the server." onRetry={() => void refetch()} />;
  return (
    <div className="page">
      <Title order={1} mb="lg">
        Projects
      </Title>
      <MyWork />
      <Group mb="sm" justify="space-between" mih={36}>
        <Title order={2}>All projects</Title>
        <Group gap="sm">
          <SegmentedControl
            size="xs"
            aria-label="Which projects"
            data={[
              { value: "no", label: "At work" },
              { value: "yes", label: "Archived" },
            ]}
            value={isArchived ? "yes" : "no"}
            onChange={(value) => setAddress(value === "yes" ? { archived: "yes" } : {}, { replace: true })}
          />
          {isLead && !isArchived && <NewProject />}
        </Group>
      </Group>
      {!data && (
        <div className={classes.cards}>
          {[0, 1, 2].map((index) => (
            <Skeleton key={index} height={128} radius="lg" />
          ))}
        </div>
      )}
      {data?.length === 0 &&
        (isArchived ? (
          <Text className="quiet">No project was put away. Archive one on its page when it is finished; its accepted frames stay locked.</Text>
        ) : (
          <EmptyState icon={<IconUsersGroup size={48} stroke={1.25} />} title="No projects yet">
            A project holds recordings and says who marks which frames. {isLead ? "Give it a name above, add recordings, assign frames to people." : "Ask a lead to make one and to give you frames."}
          </EmptyState>
        ))}
      <div className={classes.cards}>
        {data?.map((project) => (
          <ProjectCard key={project.id} project={project} isLead={isLead} />
        ))}
      </div>
    </div>
  );
}

function ProjectCard({ project, isLead }: { project: Project; isLead: boolean }) {
  const change = useTeamChange();
  const { open, returned, submitted, accepted } = project.assignments;
  const all = open + returned + submitted + accepted;
  return (
    <div className={`card ${classes.card}`}>
      <Link to={`/projects/${project.id}`} className={`${classes.link} one-line`} title={project.name}>
        {project.name}
      </Link>
      <Text size="sm" className="quiet one-line">
        {project.description || "No description"}
      </Text>
      <Text size="sm">
        {formatCount(project.recordings, "recording")} · {formatCount(all, "assignment")}
      </Text>
      {all > 0 && (
        <Stack gap={4}>
          <Progress value={(100 * accepted) / all} aria-label={`${accepted} of ${all} assignments accepted`} />
          <Text size="xs" className="quiet">
            {accepted} accepted, {submitted} in review, {returned} returned, {open} open
          </Text>
        </Stack>
      )}
      {project.archived_at && isLead && (
        <Button size="xs" variant="default" loading={change.isPending} onClick={() => change.mutate({ method: "POST", path: `/bin/project/${project.id}/restore` })}>
          Restore
        </Button>
      )}
    </div>
  );
}

function NewProject() {
  const [name, setName] = useState("");
  const change = useTeamChange<Project>();
  const navigate = useNavigate();
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        change.mutate(
          { method: "POST", path: "/projects", body: { name } },
          {
            onSuccess: (made) => void navigate(`/projects/${made.id}`),
            onError: (failure) => notifications.show({ color: "red", title: "The project was not made", message: failure.message }),
          },
        );
      }}
    >
      <Group gap="sm" wrap="nowrap">
        <TextInput size="xs" w={240} aria-label="Name of a new project" placeholder="Name of a new project" maxLength={200} value={name} onChange={(event) => setName(event.currentTarget.value)} />
        <Button size="xs" type="submit" disabled={!name.trim()} loading={change.isPending}>
          New project
        </Button>
      </Group>
    </form>
  );
}
