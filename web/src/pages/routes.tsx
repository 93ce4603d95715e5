import { createBrowserRouter, Navigate } from "react-router";
import { BrokenPage } from "./BrokenPage";
import { ImportPage } from "./ImportPage";
import { JobPage } from "./JobPage";
import { JobsPage } from "./JobsPage";
import { MissingPage } from "./MissingPage";
import { NewImportPage } from "./NewImportPage";
import { RecordingPage } from "./RecordingPage";
import { RecordingsPage } from "./RecordingsPage";
import { Shell } from "./Shell";
import { TracksPage } from "./TracksPage";


/** Addresses hold the state of a page, so that a link shows a colleague the same thing. */
export const router = createBrowserRouter([
  {
    element: <Shell />,
    errorElement: <BrokenPage />,
    children: [
      {
        errorElement: <BrokenPage />,
        children: [
          { index: true, element: <Navigate to="/recordings" replace /> },
          { path: "recordings", element: <RecordingsPage /> },
          { path: "recordings/:recordingId", element: <RecordingPage /> },
          { path: "imports/new", element: <NewImportPage /> },
          { path: "imports/:importId", element: <ImportPage /> },
          { path: "tracks", element: <TracksPage /> },
          { path: "jobs", element: <JobsPage /> },
          { path: "jobs/:jobId", element: <JobPage /> },
          { path: "*", element: <MissingPage /> },
        ],
      },
    ],
  },
]);
