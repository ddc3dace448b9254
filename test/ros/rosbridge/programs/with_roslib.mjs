// A program of roslib as its documents show it: node with_roslib.mjs MODULE ADDRESS; prints what it was told.
import { pathToFileURL } from "node:url";

const [module, address] = process.argv.slice(2);
const ROSLIB = await import(pathToFileURL(module));
const ros = new ROSLIB.Ros({ url: address });
await new Promise((resolve, reject) => {
  ros.on("connection", resolve);
  ros.on("error", reject);
});

const asked = (ask) => new Promise((resolve, reject) => ask(resolve, reject));
const told = {};
told.topics = (await asked((answer, refuse) => ros.getTopics(answer, refuse))).topics;
told.type = await asked((answer, refuse) => ros.getTopicType("/battery", answer, refuse));
told.services = await asked((answer, refuse) => ros.getServices(answer, refuse));
told.service_type = await asked((answer, refuse) => ros.getServiceType("/ask", answer, refuse));
told.nodes = await asked((answer, refuse) => ros.getNodes(answer, refuse));
told.actions = await asked((answer, refuse) => ros.getActionServers(answer, refuse));
const details = await asked((answer, refuse) => ros.getMessageDetails("sensor_msgs/BatteryState", answer, refuse));
told.details = ros.decodeTypeDefs(details);

const battery = new ROSLIB.Topic({ ros, name: "/battery", messageType: "sensor_msgs/BatteryState" });
told.battery = await asked((answer) => battery.subscribe(answer));
battery.unsubscribe();
// The bridge answers these with JSON, which roslib takes as well.
told.compressed = [];
for (const compression of ["cbor", "cbor-raw", "png"]) {
  const wished = new ROSLIB.Topic({ ros, name: "/battery", messageType: "sensor_msgs/BatteryState", compression });
  told.compressed.push((await asked((answer) => wished.subscribe(answer))).voltage);
  wished.unsubscribe();
}

const answer = new ROSLIB.Topic({ ros, name: "/answer", messageType: "std_msgs/String" });
answer.publish({ data: "hello" });

const call = (name, args) => asked((ok, no) => new ROSLIB.Service({ ros, name, serviceType: "" }).callService(args, ok, no));
told.asked = await call("/ask", { data: true });
told.refused = await call("/nowhere", {}).catch((reason) => reason);

const parameter = new ROSLIB.Param({ ros, name: "/beside/depth" });
told.parameter = await asked((ok, no) => parameter.get(ok, no));
await asked((ok, no) => new ROSLIB.Param({ ros, name: "/beside/told" }).set([1, "two"], ok, no));

const client = new ROSLIB.ActionClient({ ros, serverName: "/walk", actionName: "roomba_robot/WalkToPointAction" });
const goal = new ROSLIB.Goal({ actionClient: client, goalMessage: { destin: { dest_x: 1.25 } } });
// Two topics: the result may come before the feedback that was published first.
const feedback = asked((done) => { goal.on("feedback", done); });
told.result = await asked((done) => { goal.on("result", done); goal.send(); });
told.feedback = (await feedback).distance;

console.log(JSON.stringify(told));
process.exit(0);
