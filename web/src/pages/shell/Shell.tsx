import { ActionIcon, Group, Kbd, Text, Tooltip, UnstyledButton } from "@mantine/core";
import { IconKeyboard, IconPlugConnectedX, IconSearch } from "@tabler/icons-react";
import { useQueryClient } from "@tanstack/react-query";
import { Suspense, useEffect, useRef, useState } from "react";
import { Link, Outlet, useLocation } from "react-router";
import icon from "../../icon.svg?no-inline";
import { useKeymap } from "../../actions/useKeymap";
import { useActiveJobs, useJobStream } from "../../api/jobs";
import { useHint } from "../../state/keys";
import { flushSaving } from "../../state/saving";
import { DropAnywhere } from "./DropAnywhere";
import { KeySettings } from "./KeySettings";
import { MeMenu } from "../account/MeMenu";
import { KeyboardMap } from "./KeyboardMap";
import { PageSkeleton } from "../parts/PageSkeleton";
import { openSearch, Search } from "./Search";
import { ThemeSwitch } from "./ThemeSwitch";
import { useIsNarrow } from "../parts/useScreen";
import { nameOfRoom, roomOf, Rooms } from "./Rooms";
import { RoomsMenu } from "./RoomsMenu";
import classes from "./Shell.module.css";

function Brand() {
  return (
    <Link to="/recordings" className={classes.brand} aria-label="Handloom, to the recordings">
      <img src={icon} width={24} height={24} alt="" />
      <Text fw={650} size="md" span className={classes.brandName}>
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
  const isNarrow = useIsNarrow();
  const running = useActiveJobs().data?.length ?? 0;
  const hint = useHint();
  useKeymap("everywhere", { help: () => setHelpOpen(true), settings: () => setSettingsOpen(true), search: openSearch });

  return (
    <div className={classes.shell}>
      <a className="skip" href="#main">
        To the content
      </a>
      <header className={classes.header}>
        {isNarrow && <RoomsMenu room={room} running={running} onKeys={() => setHelpOpen(true)} />}
        <Brand />
        {isNarrow ? <span className={`${classes.where} one-line`}>{nameOfRoom(room)}</span> : <Rooms room={room} running={running} />}
        <Group gap={4} ml="auto" wrap="nowrap" miw={0}>
          {!isLinked && (
            <Tooltip label="No live connection to the studio's server; reconnecting">
              <Group gap={6} px="sm" c="var(--bad-text)" role="status" wrap="nowrap">
                <IconPlugConnectedX size={16} aria-hidden />
                <span className={classes.away}>Server away</span>
              </Group>
            </Tooltip>
          )}
          <UnstyledButton className={classes.search} onClick={openSearch}>
            <IconSearch size={15} aria-hidden />
            <span>Search</span>
            <Kbd size="xs">Ctrl K</Kbd>
          </UnstyledButton>
          {!isNarrow && (
            <>
              <Tooltip label={hint("Keyboard map", "help")}>
                <ActionIcon size="lg" aria-label="Keyboard map" onClick={() => setHelpOpen(true)}>
                  <IconKeyboard size={18} />
                </ActionIcon>
              </Tooltip>
              <ThemeSwitch />
            </>
          )}
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
