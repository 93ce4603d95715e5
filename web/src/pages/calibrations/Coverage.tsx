import { SimpleGrid, Text, Title } from "@mantine/core";
import { coverageUrl, type CalibrationResult } from "../../api/calibrations";
import { trackStyle } from "../../model/trackStyle";
import classes from "./calibrations.module.css";

/** As in `tracker/calibration/coverage.py`: residuals up to so many px. */
const LEVELS = [
  ["#009e96", "up to 0.5 px"],
  ["#e69f00", "up to 1 px"],
  ["#d55e00", "up to 2 px"],
  ["#960028", "more"],
] as const;

/** The picture of each camera: where it saw the board, and how well it fits there. */
export function Coverage({ id, result }: { id: string; result: CalibrationResult }) {
  return (
    <section aria-label="Where the board was seen">
      <Title order={2}>Where the board was seen</Title>
      <Text size="sm" className="quiet" mb="sm">
        In a crossed-out cell no corner was ever seen: there the lens is a guess.{" "}
        {LEVELS.map(([color, words]) => (
          <span key={words} style={{ display: "inline-block", marginRight: 12 }}>
            <span aria-hidden style={{ color }}>
              ●
            </span>{" "}
            {words}
          </span>
        ))}
        <span style={{ display: "inline-block" }}>○ left out</span>
      </Text>
      <SimpleGrid cols={{ base: 1, sm: 2, lg: 3 }} spacing="md">
        {result.cameras.map(({ id: camera, frames, frames_with_board: seen }, number) => (
          <figure key={camera} className={`card ${classes.figure}`}>
            <a href={coverageUrl(id, number)} target="_blank" rel="noreferrer" title="Open this picture alone">
              <img src={coverageUrl(id, number)} alt={`Where ${camera} saw the board`} className={classes.coverage} loading="lazy" />
            </a>
            <figcaption className={classes.caption}>
              <span className="one-line">
                <span aria-hidden style={{ color: trackStyle(number).color }}>
                  ■
                </span>{" "}
                {camera}
              </span>
              <span className="quiet">
                {seen} of {frames} frames
              </span>
            </figcaption>
          </figure>
        ))}
      </SimpleGrid>
    </section>
  );
}
