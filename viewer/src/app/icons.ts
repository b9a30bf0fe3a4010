/** Line icons on a grid of 24, drawn for this page: path data, stroked. */
export const ICONS = {
  home: "M4 11.5 12 4.5l8 7M6.5 9.8V19.5h11V9.8M10 19.5v-5h4v5",
  upAxis: "M12 20V5M7.5 9 12 4.5 16.5 9M5 20h14",
  colours: "M12 4.5c3.2 3.6 5 6.3 5 8.9a5 5 0 0 1-10 0c0-2.6 1.8-5.3 5-8.9zM9.6 13.6a2.5 2.5 0 0 0 2.4 2.4",
  wireframe: "M12 4 4.5 18.5h15zM12 4v14.5M8.2 11.3 12 18.5l3.8-7.2zM4.5 18.5h15",
  patches: "M4.5 5.5h6.5v5.5H4.5zM13.5 5.5h6v8h-6zM4.5 13.5h6.5v5H4.5zM13.5 16h6v2.5h-6z",
  spheres:
    "M12 4.5a7.5 7.5 0 1 1 0 15 7.5 7.5 0 0 1 0-15zM4.5 12c0 1.7 3.4 3 7.5 3s7.5-1.3 7.5-3M12 4.5c-1.7 0-3 3.4-3 7.5s1.3 7.5 3 7.5",
  refinement:
    "M3.5 12c2.4-4.3 5.2-6.4 8.5-6.4s6.1 2.1 8.5 6.4c-2.4 4.3-5.2 6.4-8.5 6.4S5.9 16.3 3.5 12zM12 8.6l3.2 5.6H8.8z",
  light:
    "M12 8a4 4 0 1 1 0 8 4 4 0 0 1 0-8zM12 3v2.2M12 18.8V21M3 12h2.2M18.8 12H21M5.6 5.6l1.6 1.6M16.8 16.8l1.6 1.6M5.6 18.4l1.6-1.6M16.8 7.2l1.6-1.6",
  levels: "M4.5 18.5v-3.5h4v3.5zM10 18.5V11h4v7.5zM15.5 18.5v-12h4v12z",
  inset: "M4.5 5.5h15v13h-15zM12.5 8h4.5v4h-4.5z",
  screenshot: "M4.5 8h3.2l1.6-2.5h5.4L16.3 8h3.2v10.5h-15zM12 10a3 3 0 1 1 0 6 3 3 0 0 1 0-6z",
  share:
    "M10.2 13.8a3.5 3.5 0 0 0 5 0l3-3a3.53 3.53 0 0 0-5-5l-1 1M13.8 10.2a3.5 3.5 0 0 0-5 0l-3 3a3.53 3.53 0 0 0 5 5l1-1",
  fullscreen: "M4.5 9V4.5H9M15 4.5h4.5V9M19.5 15v4.5H15M9 19.5H4.5V15",
  settings: "M4.5 7.5h8M16.5 7.5h3M14.5 5.5v4M4.5 16.5h3M11.5 16.5h8M9.5 14.5v4",
  theme: "M12 4.5a7.5 7.5 0 1 1 0 15 7.5 7.5 0 0 1 0-15zM12 4.5v15M12 8l5.5 5.5M12 12.5l4.5 4.5M12.5 4.5l7 7",
  status: "M4.5 17.5a8.5 8.5 0 1 1 15 0M12 14.5l3.5-4.5M12 14a1 1 0 1 1 0 2 1 1 0 0 1 0-2z",
  help: "M8.8 9.2a3.2 3.2 0 1 1 4.6 2.9c-.9.5-1.4 1-1.4 2.2M12 17.3v.4",
  close: "M6.5 6.5l11 11M17.5 6.5l-11 11",
} as const;

export type IconName = keyof typeof ICONS;

const SVG = "http://www.w3.org/2000/svg";

export function icon(name: IconName): SVGSVGElement {
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(SVG, "path");
  path.setAttribute("d", ICONS[name]);
  svg.append(path);
  return svg;
}
