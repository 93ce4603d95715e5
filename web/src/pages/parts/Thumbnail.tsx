import { useState, type CSSProperties } from "react";

interface ThumbnailProps {
  src: string;
  alt: string;
  width: number;
  height: number;
  className?: string | undefined;
  style?: CSSProperties;
}

/** A small picture; one that does not arrive leaves its place empty. */
export function Thumbnail({ src, alt, className, style, ...size }: ThumbnailProps) {
  const [broken, setBroken] = useState("");
  if (broken === src) return <span className={className} style={{ ...size, ...style, display: "inline-block" }} {...(alt && { role: "img", "aria-label": alt })} />;
  return <img {...size} src={src} alt={alt} className={className} style={style} loading="lazy" onError={() => setBroken(src)} />;
}
