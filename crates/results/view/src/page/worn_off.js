// Walls that are not coloured by what was done to them.
const worn = { on: false };
const isWorn = () => false;
const opacityOf = () => state.opacity;
const setWallMap = () => [], showWornLegend = setWallMap, wornChoices = setWallMap, wornRows = setWallMap;
