// Point clouds: binary PLY as the master writes it, vertices of numbers.
// Source: G. Turk, The PLY Polygon File Format, 1994.

export interface Cloud {
  count: number;
  positions: Float32Array; // x, y, z as in the file: z points towards the viewer
  colors: Uint8Array; // of the surfaces: linear red, green, blue; 255 is 1
}

type Read = (view: DataView, at: number) => number;
const types: Record<string, [bytes: number, read: Read]> = {
  char: [1, (v, at) => v.getInt8(at)],
  uchar: [1, (v, at) => v.getUint8(at)],
  short: [2, (v, at) => v.getInt16(at, true)],
  ushort: [2, (v, at) => v.getUint16(at, true)],
  int: [4, (v, at) => v.getInt32(at, true)],
  uint: [4, (v, at) => v.getUint32(at, true)],
  float: [4, (v, at) => v.getFloat32(at, true)],
  double: [8, (v, at) => v.getFloat64(at, true)],
};
const otherNames: Record<string, string> = {
  int8: "char",
  uint8: "uchar",
  int16: "short",
  uint16: "ushort",
  int32: "int",
  uint32: "uint",
  float32: "float",
  float64: "double",
};

interface Header {
  count: number;
  stride: number;
  body: number; // where the first vertex begins
  fields: Map<string, { at: number; read: Read }>;
}

function headerOf(buffer: ArrayBuffer): Header {
  const text = new TextDecoder("latin1").decode(new Uint8Array(buffer, 0, Math.min(buffer.byteLength, 4096)));
  const end = text.indexOf("end_header\n");
  if (!text.startsWith("ply\n") || end < 0) throw new Error("the point cloud is no PLY file");
  const header: Header = { count: 0, stride: 0, body: end + "end_header\n".length, fields: new Map() };
  for (const line of text.slice(0, end).split("\n")) {
    const [word, first = "", second = ""] = line.split(" ");
    if (word === "format" && first !== "binary_little_endian")
      throw new Error(`a PLY file in ${first} cannot be shown`);
    if (word === "element" && first !== "vertex")
      throw new Error(`a PLY file with ${first} elements cannot be shown`);
    if (word === "element") header.count = Number(second);
    if (word !== "property") continue;
    const type = types[otherNames[first] ?? first];
    if (!type) throw new Error(`a PLY file with numbers of type ${first} cannot be shown`);
    header.fields.set(second, { at: header.stride, read: type[1] });
    header.stride += type[0];
  }
  return header;
}

export function parsePly(buffer: ArrayBuffer): Cloud {
  const { count, stride, body, fields } = headerOf(buffer);
  if (buffer.byteLength < body + count * stride) throw new Error("the point cloud ends too early");
  const view = new DataView(buffer, body);
  const field = (name: string) => {
    const found = fields.get(name);
    if (!found) throw new Error(`the point cloud has no ${name}`);
    return found;
  };
  const axes = ["x", "y", "z"].map(field);
  const channels = ["red", "green", "blue"].map(field);

  const positions = new Float32Array(3 * count);
  const colors = new Uint8Array(3 * count);
  for (let i = 0, at = 0; i < count; ++i, at += stride) {
    for (let k = 0; k < 3; ++k) {
      positions[3 * i + k] = axes[k]!.read(view, at + axes[k]!.at);
      colors[3 * i + k] = channels[k]!.read(view, at + channels[k]!.at);
    }
  }
  return { count, positions, colors };
}
