// web-ifc (npm) as an independent reader of IFC, run by node as a child process.
//   node web_ifc.mjs time PLAN.ifc          one JSON object: milliseconds to open, and to open and tessellate all (and of all
//                                         its threads' processor time for that); peak memory in bytes
//   node web_ifc.mjs walls PLAN.ifc OUT     the triangles of every wall, see WriteWalls
// The package is looked for in the folder $PLUMB_WEB_IFC and where `npm install -g` puts it. Exit status 3: it is not there.
import { execSync } from 'node:child_process';
import { createWriteStream, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

function loadWebIfc() {
  const folders = process.env.PLUMB_WEB_IFC ? [process.env.PLUMB_WEB_IFC] : [];
  try {
    folders.push(execSync('npm root -g', { stdio: ['ignore', 'pipe', 'ignore'] }).toString().trim());
  } catch {
    // no npm: the folder alone
  }
  for (const folder of folders) {
    for (const base of [`${folder}/`, `${folder}/node_modules/`]) {
      try {
        return createRequire(base)(createRequire(base).resolve('web-ifc', { paths: [folder, base] }));
      } catch {
        // the next one
      }
    }
  }
  process.stderr.write('web-ifc is not installed: npm install -g web-ifc, or set PLUMB_WEB_IFC to a folder that has it\n');
  process.exit(3);
}

async function open(webIfc, api, path) {
  await api.Init();
  api.SetLogLevel(webIfc.LogLevel.LOG_LEVEL_OFF);
  const start = performance.now(), cpu = process.cpuUsage();
  const model = api.OpenModel(new Uint8Array(readFileSync(path)));
  return { model, start, cpu };
}

async function time(webIfc, path) {
  const api = new webIfc.IfcAPI();
  const { model, start, cpu } = await open(webIfc, api, path);
  const opened = performance.now();
  let products = 0;
  api.StreamAllMeshes(model, () => ++products);
  const done = performance.now(), used = process.cpuUsage(cpu);
  const peak = 1024 * process.resourceUsage().maxRSS;
  console.log(JSON.stringify({ open_ms: opened - start, all_ms: done - start, cpu_ms: (used.user + used.system) / 1000, products, peak_bytes: peak }));
}

// Per part of a wall: GlobalId (22 characters), two spaces, number of triangles (uint32), nine float64 a triangle, metres, z up.
async function writeWalls(webIfc, path, out) {
  const api = new webIfc.IfcAPI();
  const { model } = await open(webIfc, api, path);
  const types = [webIfc.IFCWALL, webIfc.IFCWALLSTANDARDCASE, webIfc.IFCWALLELEMENTEDCASE];
  const file = createWriteStream(out);
  api.StreamAllMeshesWithTypes(model, types, (mesh) => {
    const guid = api.GetLine(model, mesh.expressID).GlobalId.value;
    for (let i = 0; i < mesh.geometries.size(); ++i) {
      const placed = mesh.geometries.get(i), m = placed.flatTransformation;
      const geometry = api.GetGeometry(model, placed.geometryExpressID);
      const vertices = api.GetVertexArray(geometry.GetVertexData(), geometry.GetVertexDataSize());  // x y z and a normal
      const indices = api.GetIndexArray(geometry.GetIndexData(), geometry.GetIndexDataSize());
      const corners = new Float64Array(3 * indices.length);
      indices.forEach((index, k) => {
        const [x, y, z] = vertices.subarray(6 * index, 6 * index + 3);
        const at = (row) => m[row] * x + m[row + 4] * y + m[row + 8] * z + m[row + 12];
        corners.set([at(0), -at(2), at(1)], 3 * k);  // web-ifc turns y up
      });
      const head = Buffer.alloc(28);
      head.write(guid.padEnd(24, ' '), 'latin1');
      head.writeUInt32LE(indices.length / 3, 24);
      file.write(head);
      file.write(Buffer.from(corners.buffer));
      geometry.delete();
    }
  });
  await new Promise((done) => file.end(done));
}

const [mode, path, out] = process.argv.slice(2);
const webIfc = loadWebIfc();
if (mode === 'time' && path) await time(webIfc, path);
else if (mode === 'walls' && out) await writeWalls(webIfc, path, out);
else {
  process.stderr.write('usage: node web_ifc.mjs time PLAN.ifc | walls PLAN.ifc OUT\n');
  process.exit(2);
}
