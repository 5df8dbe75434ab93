import { describe, expect, it } from "vitest";
import { parsePly } from "../../../master/web/src/rays/ply";

const names = [
  "float x",
  "float y",
  "float z",
  "float nx",
  "float ny",
  "float nz",
  "uchar red",
  "uchar green",
  "uchar blue",
];

function plyOf(points: number[][], header: string): ArrayBuffer {
  const bytes = new Uint8Array(header.length + points.length * 27);
  bytes.set(new TextEncoder().encode(header));
  const view = new DataView(bytes.buffer, header.length);
  points.forEach((point, i) =>
    point.forEach((value, k) => {
      if (k < 6) view.setFloat32(27 * i + 4 * k, value, true);
      else view.setUint8(27 * i + 18 + k, value);
    }),
  );
  return bytes.buffer;
}
const headerOf = (count: number, format = "binary_little_endian"): string =>
  `ply\nformat ${format} 1.0\ncomment rayfarm\nelement vertex ${count}\n` +
  names.map((name) => `property ${name}\n`).join("") +
  "end_header\n";

describe("a point cloud", () => {
  const points = [
    [1, 2, -3, 0, 1, 0, 0, 128, 255],
    [0.5, -0.25, 1e6, 0, 0, -1, 255, 1, 2],
  ];

  it("is read as it was written", () => {
    const cloud = parsePly(plyOf(points, headerOf(2)));
    expect(cloud.count).toBe(2);
    expect([...cloud.positions]).toEqual([1, 2, -3, 0.5, -0.25, 1e6]);
    expect([...cloud.colors]).toEqual([0, 128, 255, 255, 1, 2]);
  });

  it("of no points is empty", () => {
    expect(parsePly(plyOf([], headerOf(0))).positions).toHaveLength(0);
  });

  it("with other fields is read by their names", () => {
    const header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" +
      ["uint8 blue", "uint8 green", "uint8 red", "int16 quality", "float64 z", "float32 y", "float32 x"]
        .map((name) => `property ${name}\n`)
        .join("") +
      "end_header\n";
    const bytes = new Uint8Array(header.length + 21);
    bytes.set(new TextEncoder().encode(header));
    bytes.set([3, 2, 1], header.length);
    const view = new DataView(bytes.buffer, header.length);
    view.setFloat64(5, 30, true);
    view.setFloat32(13, 20, true);
    view.setFloat32(17, 10, true);
    expect(parsePly(bytes.buffer)).toMatchObject({
      positions: Float32Array.of(10, 20, 30),
      colors: Uint8Array.of(1, 2, 3),
    });
  });

  it("that is none, cut off or of another form is refused in words", () => {
    expect(() => parsePly(new ArrayBuffer(10))).toThrow("no PLY file");
    expect(() => parsePly(plyOf(points, headerOf(3)))).toThrow("ends too early");
    expect(() => parsePly(plyOf([], headerOf(0, "ascii")))).toThrow("ascii");
    expect(() => parsePly(plyOf([], headerOf(0).replace("float z", "float w")))).toThrow("no z");
    expect(() => parsePly(plyOf([], headerOf(0).replace("float x", "list x")))).toThrow("type list");
  });
});
