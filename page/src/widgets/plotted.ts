/** A chart by uPlot: a chunk of its own. */
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { colour } from "../look.svelte";
import type { Chart, Line } from "./chart";

function series(line: Line): uPlot.Series {
	const stroke = colour(line.colour);
	switch (line.kind) {
		case "line":
			return { label: line.name, stroke, width: 2, points: { show: true, size: 7, fill: stroke } };
		case "points":
			return { label: line.name, stroke, paths: () => null, points: { show: true, size: 8, fill: stroke } };
		case "limit":
			return { label: line.name, stroke, width: 1.5, dash: [7, 5], points: { show: false } };
	}
}

export function plotted(box: HTMLElement, chart: Chart): uPlot {
	const ink = colour("soft");
	const grid = { stroke: colour("line"), width: 1 };
	const axis = {
		stroke: ink,
		grid,
		ticks: grid,
		font: "12px system-ui, sans-serif",
		labelFont: "12px system-ui, sans-serif",
	};
	const options: uPlot.Options = {
		width: box.clientWidth,
		height: chart.height ?? 240,
		scales: { x: { time: chart.time } },
		legend: { show: chart.lines.length > 1, live: false },
		cursor: { drag: { x: false, y: false } },
		axes: [
			{ ...axis, label: chart.xLabel, labelSize: 22 },
			{ ...axis, label: chart.yLabel, labelSize: 22, size: 62 },
		],
		series: [{}, ...chart.lines.map(series)],
	};
	const data = [[...chart.x], ...chart.lines.map((line) => [...line.y])] as uPlot.AlignedData;
	return new uPlot(options, data, box);
}
