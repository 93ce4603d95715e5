import { lazy } from "react";
import { createBrowserRouter, Navigate } from "react-router";
import { BrokenPage } from "./shell/BrokenPage";
import { JobPage } from "./jobs/JobPage";
import { JobsPage } from "./jobs/JobsPage";
import { MissingPage } from "./shell/MissingPage";
import { NewImportPage } from "./imports/NewImportPage";
import { RecordingPage } from "./recordings/RecordingPage";
import { RecordingsPage } from "./recordings/RecordingsPage";
import { Shell } from "./shell/Shell";
import { TracksPage } from "./tracks/TracksPage";
import { WholeAddress } from "./shell/WholeAddress";

const AnnotatePage = lazy(() => import("./annotate/AnnotatePage"));
const AnnotateChooser = lazy(() => import("./annotate/AnnotateChooser"));
const ComparePage = lazy(() => import("./jobs/ComparePage"));
const LabelsPage = lazy(() => import("./labels/LabelsPage"));
const ImportPage = lazy(() => import("./imports/ImportPage"));
const CuratePage = lazy(() => import("./curate/CuratePage"));
const ReviewAgreementPage = lazy(() => import("./curate/ReviewAgreementPage"));
const ScansPage = lazy(() => import("./scans/ScansPage"));
const ScanPage = lazy(() => import("./scans/ScanPage"));
const MovingScansPage = lazy(() => import("./moving/MovingScansPage"));
const MovingScanPage = lazy(() => import("./moving/MovingScanPage"));
const ModelsPage = lazy(() => import("./models/ModelsPage"));
const ModelPage = lazy(() => import("./models/ModelPage"));
const BodyPage = lazy(() => import("./body/BodyPage"));
const EvaluationsPage = lazy(() => import("./evaluations/EvaluationsPage"));
const AccountPage = lazy(() => import("./account/AccountPage"));
const PeoplePage = lazy(() => import("./account/PeoplePage"));
const ApiPage = lazy(() => import("./api/ApiPage"));
const AuditPage = lazy(() => import("./account/AuditPage"));
const BinPage = lazy(() => import("./account/BinPage"));
const AgreementPage = lazy(() => import("./projects/AgreementPage"));
const ProjectPage = lazy(() => import("./projects/ProjectPage"));
const ProjectsPage = lazy(() => import("./projects/ProjectsPage"));
const CalibrationsPage = lazy(() => import("./calibrations/CalibrationsPage"));
const CalibrationPage = lazy(() => import("./calibrations/CalibrationPage"));
const NewCalibrationPage = lazy(() => import("./calibrations/NewCalibrationPage"));
const LabelCheckPage = lazy(() => import("./quality/LabelCheckPage"));
const TrackPage = lazy(() => import("./tracks/TrackPage"));

/** Addresses hold the state of a page, so that a link shows a colleague the same thing. */
export const router = createBrowserRouter([
  {
    element: <Shell />,
    errorElement: <BrokenPage />,
    children: [
      {
        element: <WholeAddress />,
        errorElement: <BrokenPage />,
        children: [
          { index: true, element: <Navigate to="/recordings" replace /> },
          { path: "recordings", element: <RecordingsPage /> },
          { path: "recordings/:recordingId", element: <RecordingPage /> },
          { path: "recordings/:recordingId/labels", element: <LabelsPage /> },
          { path: "recordings/:recordingId/annotate", element: <AnnotatePage /> },
          { path: "recordings/:recordingId/check", element: <LabelCheckPage /> },
          { path: "annotate", element: <AnnotateChooser /> },
          { path: "imports/new", element: <NewImportPage /> },
          { path: "imports/:importId", element: <ImportPage /> },
          { path: "calibrations", element: <CalibrationsPage /> },
          { path: "calibrations/new", element: <NewCalibrationPage /> },
          { path: "calibrations/:calibrationId", element: <CalibrationPage /> },
          { path: "projects", element: <ProjectsPage /> },
          { path: "projects/:projectId", element: <ProjectPage /> },
          { path: "projects/:projectId/agreement/:setId", element: <AgreementPage /> },
          { path: "tracks", element: <TracksPage /> },
          { path: "tracks/:trackId", element: <TrackPage /> },
          { path: "scans", element: <ScansPage /> },
          { path: "scans/moving", element: <MovingScansPage /> },
          { path: "scans/moving/:movingScanId", element: <MovingScanPage /> },
          { path: "scans/:scanId", element: <ScanPage /> },
          { path: "curate", element: <CuratePage /> },
          { path: "curate/agreement", element: <ReviewAgreementPage /> },
          { path: "models", element: <ModelsPage /> },
          { path: "models/body", element: <BodyPage /> },
          { path: "models/:modelId", element: <ModelPage /> },
          { path: "evaluations", element: <EvaluationsPage /> },
          { path: "jobs", element: <JobsPage /> },
          { path: "jobs/compare", element: <ComparePage /> },
          { path: "jobs/:jobId", element: <JobPage /> },
          { path: "account", element: <AccountPage /> },
          { path: "people", element: <PeoplePage /> },
          { path: "audit", element: <AuditPage /> },
          { path: "bin", element: <BinPage /> },
          { path: "docs/api", element: <ApiPage /> },
          { path: "login", element: <Navigate to="/recordings" replace /> },
          { path: "*", element: <MissingPage /> },
        ],
      },
    ],
  },
]);
