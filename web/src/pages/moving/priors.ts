import type { Prior } from "../../api/movingScans";

/** What hands are expected to do, in people's words. */
export const PRIORS: Record<Prior, { label: string; help: string }> = {
  mixture: { label: "mixture prior", help: "Hands are held in one of ten typical ways, as in the paper" },
  gaussian: { label: "one Gaussian", help: "Hands stay near their mean pose" },
  none: { label: "no prior", help: "Hands follow the points alone" },
};
