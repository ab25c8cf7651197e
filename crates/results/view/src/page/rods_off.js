// A page without bonds, arrows, contacts and outlines.
const rods = { layers: [], start() {}, shown: () => [], draw() {} };
const bondCounts = () => null, chainWords = () => [], showRodLegend = () => {}, showArrow = showRodLegend;
