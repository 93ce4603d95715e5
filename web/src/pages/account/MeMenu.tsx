import { Menu, Text, UnstyledButton } from "@mantine/core";
import { IconApi, IconHistory, IconLogout, IconTrash, IconUserCircle, IconUsers } from "@tabler/icons-react";
import { Link } from "react-router";
import { hasRole, useMe } from "../../state/me";
import classes from "./MeMenu.module.css";
import { useLogOut } from "./useLogOut";

/** Who am I, at the end of the header. */
export function MeMenu() {
  const me = useMe();
  const { ask, question } = useLogOut();
  return (
    <>
      {question}
      <Menu position="bottom-end" width={232} withArrow>
        <Menu.Target>
          <UnstyledButton className={classes.me} aria-label={`Account of ${me.name}`}>
            <span className={classes.initial} data-initial={me.name.slice(0, 1).toUpperCase()} aria-hidden />
            <span className={classes.name}>{me.name}</span>
          </UnstyledButton>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Label>
            <Text size="sm" fw={600} c="var(--mantine-color-text)" truncate>
              {me.name}
            </Text>
            {me.is_login_needed ? me.role : "at this machine, no login needed"}
          </Menu.Label>
          <Menu.Item component={Link} to="/account" leftSection={<IconUserCircle size={16} />}>
            My account
          </Menu.Item>
          {hasRole(me, "lead") && (
            <>
              <Menu.Item component={Link} to="/people" leftSection={<IconUsers size={16} />}>
                People
              </Menu.Item>
              <Menu.Item component={Link} to="/audit" leftSection={<IconHistory size={16} />}>
                Audit trail
              </Menu.Item>
              <Menu.Item component={Link} to="/bin" leftSection={<IconTrash size={16} />}>
                Bin
              </Menu.Item>
            </>
          )}
          <Menu.Item component={Link} to="/docs/api" leftSection={<IconApi size={16} />}>
            API for scripts
          </Menu.Item>
          {me.is_login_needed && (
            <>
              <Menu.Divider />
              <Menu.Item leftSection={<IconLogout size={16} />} onClick={ask}>
                Log out
              </Menu.Item>
            </>
          )}
        </Menu.Dropdown>
      </Menu>
    </>
  );
}
