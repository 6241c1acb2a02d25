// Plots of curves over time.
export { default as uPlot } from "uplot";
