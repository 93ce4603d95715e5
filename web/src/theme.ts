/** One look for all pages: graphite grounds against which images are judged, one accent, an 8 px grid. */

import { createTheme, type CSSVariablesResolver, type MantineColorsTuple } from "@mantine/core";
import { HAND_COLORS, OBJECT_COLOR } from "./model/joints";

const graphite: MantineColorsTuple = [
  "#dfe2e6", "#b6bcc5", "#98a0ab", "#6d7580", "#3b414a", "#2c3138", "#22262c", "#17191d", "#101215", "#0b0c0e",
];

const teal: MantineColorsTuple = [
  "#e2faf7", "#c5f1eb", "#96e4da", "#5fd3c6", "#36c3b4", "#1cb5a5", "#0ea394", "#078577", "#046a5f", "#024c45",
];

export const theme = createTheme({
  fontFamily: '"Inter Variable", system-ui, sans-serif',
  fontFamilyMonospace: 'ui-monospace, "SF Mono", "DejaVu Sans Mono", monospace',
  headings: { fontWeight: "620", sizes: { h1: { fontSize: "24px", lineHeight: "32px" }, h2: { fontSize: "18px", lineHeight: "24px" }, h3: { fontSize: "14px", lineHeight: "24px" } } },
  fontSizes: { xs: "12px", sm: "13px", md: "14px", lg: "16px", xl: "20px" },
  lineHeights: { xs: "16px", sm: "20px", md: "20px", lg: "24px", xl: "28px" },
  spacing: { xs: "4px", sm: "8px", md: "16px", lg: "24px", xl: "32px" },
  radius: { xs: "2px", sm: "4px", md: "6px", lg: "8px", xl: "12px" },
  defaultRadius: "md",
  colors: { dark: graphite, teal },
  primaryColor: "teal",
  primaryShade: { light: 7, dark: 7 },
  focusRing: "auto",
  respectReducedMotion: true,
  cursorType: "pointer",
  components: {
    Tooltip: { defaultProps: { withArrow: true, openDelay: 350, fz: "xs", zIndex: 400 } },
    ActionIcon: { defaultProps: { variant: "subtle", color: "gray" } },
    Modal: { defaultProps: { centered: true, closeButtonProps: { "aria-label": "Close" }, overlayProps: { backgroundOpacity: 0.6 }, transitionProps: { duration: 120 } } },
    // Beside a name that is too long it is the name that gives way.
    Badge: { styles: { root: { flexShrink: 0 } } },
    Button: { defaultProps: { size: "sm" }, styles: { root: { flexShrink: 0 } } },
    Skeleton: { defaultProps: { radius: "sm" } },
  },
});

export const cssVariables: CSSVariablesResolver = () => ({
  variables: {
    "--hand-right": HAND_COLORS.right,
    "--hand-left": HAND_COLORS.left,
    "--object": OBJECT_COLOR,
    "--suggestion": "#b08cff",
    "--bad": "#ff5d52",
  },
  light: {
    "--mantine-color-body": "#f6f7f8",
    "--surface": "#ffffff",
    "--surface-sunken": "#eceef1",
    "--line": "#dcdfe4",
    "--text-quiet": "#565d68",
    "--hand-right-text": "#a04a00",
    "--hand-left-text": "#1459b8",
    "--object-text": "#276a2b",
    "--bad-text": "#b3261e",
    "--warn-text": "#8a5a00",
    "--accent-text": "#046a5f",
    "--pane": "#3a3f46",
    "--edge": "rgb(0 0 0 / 28%)",
    "--mantine-color-dimmed": "#565d68",
  },
  dark: {
    "--surface": "#1e2126",
    "--surface-sunken": "#101215",
    "--line": "#31363e",
    "--text-quiet": "#a0a8b3",
    "--hand-right-text": "#ffa94d",
    "--hand-left-text": "#7cb8ff",
    "--object-text": "#82d486",
    "--bad-text": "#ff8a81",
    "--warn-text": "#f0b45a",
    "--accent-text": "#5fd3c6",
    "--pane": "#0b0c0e",
    "--edge": "rgb(160 168 179 / 45%)",
    "--mantine-color-dimmed": "#a0a8b3",
  },
});
