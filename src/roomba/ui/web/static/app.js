/** The page: its parts, begun one after the other. */
import * as draw from "./map/draw.js";
import * as gestures from "./map/gestures.js";
import * as actions from "./panels/actions.js";
import * as camera from "./panels/camera.js";
import * as card from "./panels/card.js";
import * as charts from "./panels/charts.js";
import * as drive from "./panels/drive.js";
import * as history from "./panels/history.js";
import * as keys from "./panels/keys.js";
import * as lowThings from "./panels/low_things.js";
import * as maps from "./panels/maps.js";
import { tapped } from "./panels/offer.js";
import * as plans from "./panels/plans.js";
import * as play from "./panels/play.js";
import * as queue from "./panels/queue.js";
import * as replay from "./panels/replay.js";
import * as rooms from "./panels/rooms.js";
import * as sheet from "./panels/sheet.js";
import * as status from "./panels/status.js";
import * as tools from "./panels/view.js";
import * as upkeep from "./panels/upkeep.js";
import * as zones from "./panels/zones.js";
import { connect } from "./link.js";

draw.begin();
gestures.begin({ tapped, drawn: zones.drawn, changed: zones.change, mayCarry: play.mayCarry, carried: play.carried });
for (const panel of [status, card, actions, rooms, queue, zones, drive, play, tools, keys, replay, maps, lowThings, plans, upkeep, camera, charts, history, sheet]) panel.begin();
connect();
