import { useState } from "react";
import { thumbnailUrl } from "../../api/recordings";
import type { Camera, Recording } from "../../api/types";

export function CameraPicture({ recording, camera }: { recording: Recording; camera: Camera }) {
  const [isBroken, setBroken] = useState(false);
  return (
    <div style={{ width: 176, minHeight: 120, flex: "none", background: "var(--pane)" }}>
      {!isBroken && (
        <img
          src={thumbnailUrl(recording, camera.id, 0)}
          alt={`First frame of ${camera.id}`}
          onError={() => setBroken(true)}
          style={{ width: "100%", height: "100%", objectFit: "contain", display: "block" }}
        />
      )}
    </div>
  );
}
