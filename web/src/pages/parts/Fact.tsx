import { Text } from "@mantine/core";
import type { ReactNode } from "react";

/** A figure with its name above it. */
export function Fact({ label, children }: { label: string; children: ReactNode }) {
  return (
    <div className="card" style={{ padding: "8px 16px", minWidth: 0 }}>
      <Text size="xs" className="quiet">
        {label}
      </Text>
      <Text size="lg" fw={600} component="div" className="one-line">
        {children}
      </Text>
    </div>
  );
}
