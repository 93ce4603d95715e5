import "@fontsource-variable/inter/index.css";
import "./mantine.css";
import "@mantine/notifications/styles.css";
import "@mantine/spotlight/styles.css";
import "./global.css";

import { localStorageColorSchemeManager, MantineProvider } from "@mantine/core";
import { Notifications } from "@mantine/notifications";
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { RouterProvider } from "react-router";
import { ApiError } from "./api/client";
import { router } from "./pages/routes";
import { Gate } from "./pages/parts/LoginGate";
import { askWhoIAm } from "./state/me";
import { cssVariables, theme } from "./theme";

/** A studio on this computer answers without any network: requests go out whatever the browser says of it, and fail with words. */
const ANYHOW = { networkMode: "always" } as const;

const queries = new QueryClient({
  defaultOptions: {
    queries: {
      ...ANYHOW,
      // "Always" would leave it out.
      refetchOnReconnect: true,
      staleTime: 10_000,
      retry: (count, failure) => failure instanceof ApiError && failure.isOffline && count < 2,
      retryDelay: 500,
    },
    mutations: ANYHOW,
  },
});

void askWhoIAm();

const root = document.getElementById("root");
if (root) {
  createRoot(root).render(
    <StrictMode>
      <MantineProvider
        theme={theme}
        cssVariablesResolver={cssVariables}
        defaultColorScheme="dark"
        colorSchemeManager={localStorageColorSchemeManager({ key: "handloom/colours" })}
      >
        <Notifications position="bottom-center" limit={4} />
        <QueryClientProvider client={queries}>
          <Gate>
            <RouterProvider router={router} />
          </Gate>
        </QueryClientProvider>
      </MantineProvider>
    </StrictMode>,
  );
}
