import { ActionIcon, Badge, Group, Kbd, Text, Tooltip, UnstyledButton, useComputedColorScheme, useMantineColorScheme } from "@mantine/core";
import { IconKeyboard, IconMoon, IconPlugConnectedX, IconSearch, IconSun } from "@tabler/icons-react";
import { useQueryClient } from "@tanstack/react-query";
import { Suspense, useEffect, useRef, useState } from "react";
import { Link, Outlet, useLocation } from "react-router";
import { useKeymap } from "../actions/useKeymap";
import { useActiveJobs, useJobStream } from "../api/jobs";
import { useHint } from "../state/keys";
import { flushSaving } from "../state/saving";
import { DropAnywhere } from "./parts/DropAnywhere";
import { KeySettings } from "./parts/KeySettings";
import { MeMenu } from "./account/MeMenu";
import { KeyboardMap } from "./parts/KeyboardMap";
import { PageSkeleton } from "./parts/PageSkeleton";
import { openSearch, Search } from "./parts/Search";
import classes from "./Shell.module.css";

const ROOMS = [
  { to: "/recordings", label: "Recordings" },
  { to: "/annotate", label: "Annotate" },
  { to: "/projects", label: "Projects" },
  { to: "/tracks", label: "Tracks" },
  { to: "/scans", label: "Scans" },
  { to: "/curate", label: "Curate" },
  { to: "/models", label: "Models" },
  { to: "/evaluations", label: "Evaluations" },
  { to: "/jobs", label: "Jobs" },
] as const;

/** An annotator's address lies below its recording, but it is another room. */
function roomOf(path: string): string {
  if (path.endsWith("/annotate")) return "/annotate";
  return path.startsWith("/imports") ? "/recordings" : `/${path.split("/")[1] ?? ""}`;
}

function ThemeSwitch() {
  const { setColorScheme } = useMantineColorScheme();
  const isDark = useComputedColorScheme("dark") === "dark";
  const label = isDark ? "Light colours" : "Dark colours";
  return (
    <Tooltip label={label}>
      <ActionIcon size="lg" aria-label={label} onClick={() => setColorScheme(isDark ? "light" : "dark")}>
        {isDark ? <IconSun size={18} /> : <IconMoon size={18} />}
      </ActionIcon>
    </Tooltip>
  );
}

function Brand() {
  return (
    <Link to="/recordings" className={classes.brand} aria-label="Handloom, to the recordings">
      <img src="/icon.svg" width={24} height={24} alt="" />
      <Text fw={650} size="md" span>
        Handloom
      </Text>
    </Link>
  );
}

/** When the server is back: send what waits and load what could not be loaded. */
function useReturn(isLinked: boolean): void {
  const client = useQueryClient();
  const wasLinked = useRef(isLinked);
  useEffect(() => {
    if (isLinked && !wasLinked.current) {
      flushSaving();
      void client.invalidateQueries();
    }
    wasLinked.current = isLinked;
  }, [isLinked, client]);
}

/** Header, navigation and what is true on every page; the page itself is the outlet. */
export function Shell() {
  const [isHelpOpen, setHelpOpen] = useState(false);
  const [isSettingsOpen, setSettingsOpen] = useState(false);
  const room = roomOf(useLocation().pathname);
  const isLinked = useJobStream();
  useReturn(isLinked);
  const running = useActiveJobs().data?.length ?? 0;
  const hint = useHint();
  useKeymap("everywhere", { help: () => setHelpOpen(true), settings: () => setSettingsOpen(true), search: openSearch });

  return (
    <div className={classes.shell}>
      <a className="skip" href="#main">
        To the content
      </a>
      <header className={classes.header}>
        <Brand />
        <nav aria-label="Rooms" className={classes.rooms}>
          {ROOMS.map(({ to, label }) => (
            <Link key={to} to={to} className={`${classes.room} ${room === to ? classes.here : ""}`} aria-current={room === to ? "page" : undefined}>
              {label}
              {to === "/jobs" && running > 0 && (
                <Badge size="sm" circle variant="filled" ml={6} aria-label={`${running} running`}>
                  {running}
                </Badge>
              )}
            </Link>
          ))}
        </nav>
        <Group gap={4} ml="auto" wrap="nowrap" miw={0}>
          {!isLinked && (
            <Tooltip label="No live connection to the studio's server; trying again by itself">
              <Group gap={6} px="sm" c="var(--bad-text)" role="status" wrap="nowrap">
                <IconPlugConnectedX size={16} aria-hidden />
                <Text size="sm">Server away</Text>
              </Group>
            </Tooltip>
          )}
          <UnstyledButton className={classes.search} onClick={openSearch}>
            <IconSearch size={15} aria-hidden />
            <span>Search</span>
            <Kbd size="xs">Ctrl K</Kbd>
          </UnstyledButton>
          <Tooltip label={hint("Keyboard map", "help")}>
            <ActionIcon size="lg" aria-label="Keyboard map" onClick={() => setHelpOpen(true)}>
              <IconKeyboard size={18} />
            </ActionIcon>
          </Tooltip>
          <ThemeSwitch />
          <MeMenu />
        </Group>
      </header>
      <main id="main" className={classes.main}>
        <Suspense fallback={<PageSkeleton />}>
          <Outlet />
        </Suspense>
      </main>
      <KeyboardMap isOpen={isHelpOpen} onClose={() => setHelpOpen(false)} onSettings={() => (setHelpOpen(false), setSettingsOpen(true))} />
      <KeySettings isOpen={isSettingsOpen} onClose={() => setSettingsOpen(false)} />
      <Search />
      <DropAnywhere />
    </div>
  );
}
