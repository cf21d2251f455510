// Path data of the icons, drawn as lines in a 24 x 24 box.
export const kIcons = {
  plus: "M12 5v14M5 12h14",
  minus: "M5 12h14",
  fit: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  swap: "M7 8h12l-3-3M17 16H5l3 3",
  open: "M4 19V6h5l2 2h9v11zM12 17v-6M9.5 13 12 10.5l2.5 2.5",
  lock: "M7 11V8a5 5 0 0 1 10 0v3M5 11h14v9H5z",
  close: "M6 6l12 12M18 6 6 18",
  mesh: "M3 20 9.5 4 21 9.5 15 20zM3 20l18-10.5M9.5 4 15 20",
} as const;
