/** Where zones are on the map, and what becomes of them when they are moved. */
import { get } from "../store.js";
import { toScreen } from "./view.js";

const NEAR = 14; // pixels from a corner, or from a wall, that still hit it

/** Return the zone at a place, m and pixels, or nothing; the newest lies on top. */
export function zoneAt(x, y, px, py) {
  return [...(get("home")?.zones ?? [])].reverse().find((zone) => isHit(zone, x, y, px, py));
}

/** Whether a zone is at a place. */
export function isHit(zone, x, y, px, py) {
  if (zone.kind !== "wall") return isInside([zone.points], x, y);
  const [[ax, ay], [bx, by]] = zone.points.map((point) => toScreen(...point)), length = (bx - ax) ** 2 + (by - ay) ** 2;
  const share = Math.max(0, Math.min(1, length ? ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / length : 0));
  return Math.hypot(px - ax - share * (bx - ax), py - ay - share * (by - ay)) < NEAR;
}

/** Return the number of a zone's corner near pixels, or -1. */
export function cornerAt(zone, px, py) {
  return zone.points.findIndex((point) => {
    const [x, y] = toScreen(...point);
    return Math.hypot(px - x, py - y) < NEAR;
  });
}

/** Return a zone elsewhere by so many m. */
export function shifted(zone, dx, dy) {
  return { ...zone, points: zone.points.map(([x, y]) => [x + dx, y + dy]) };
}

/** Return a zone with a corner elsewhere; one along the axes stays so. */
export function withCorner(zone, number, x, y) {
  const [wasX, wasY] = zone.points[number];
  const isBox = zone.points.length === 4 && zone.points.every(([ax, ay]) => zone.points.filter(([bx, by]) => bx === ax || by === ay).length === 3);
  return {
    ...zone,
    points: zone.points.map(([ax, ay], index) => index === number ? [x, y] : isBox ? [ax === wasX ? x : ax, ay === wasY ? y : ay] : [ax, ay]),
  };
}

/** Whether a point lies within rings, by the even-odd rule. */
export function isInside(rings, x, y) {
  let inside = false;
  for (const ring of rings)
    for (let one = 0, other = ring.length - 1; one < ring.length; other = one++) {
      const [ax, ay] = ring[one], [bx, by] = ring[other];
      if ((ay > y) !== (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax)) inside = !inside;
    }
  return inside;
}
