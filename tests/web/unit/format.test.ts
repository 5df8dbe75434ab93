import { describe, expect, it } from "vitest";
import { ago, bytes, count, duration, many, percent, short, timeOfDay } from "../../../master/web/src/app/format";

describe("numbers as people read them", () => {
  it.each([
    [0, "0"],
    [999, "999"],
    [1000, "1\u202f000"],
    [1234567.4, "1\u202f234\u202f567"],
    [-1234, "-1\u202f234"],
  ])("count(%d) is %s", (value, text) => expect(count(value)).toBe(text));

  it.each([
    [0, "0"],
    [7.4, "7"],
    [999.4, "999"],
    [999.6, "1.00 k"],
    [1240, "1.24 k"],
    [9996, "10.0 k"],
    [99960, "100 k"],
    [18.3e6, "18.3 M"],
    [2.5e9, "2.50 G"],
    [7.7e15, "7700 T"],
  ])("short(%d) is %s", (value, text) => expect(short(value)).toBe(text));

  it.each([
    [0, "0.0 s"],
    [0.012, "< 0.1 s"],
    [0.42, "0.4 s"],
    [9.96, "10 s"],
    [59.4, "59 s"],
    [59.6, "1 min 00 s"],
    [185, "3 min 05 s"],
    [3600, "1 h 00 min"],
    [9600, "2 h 40 min"],
    [86399, "23 h 59 min"],
    [273600, "3 d 4 h"],
  ])("duration(%d) is %s", (seconds, text) => expect(duration(seconds)).toBe(text));

  it("timeOfDay has hours, minutes and seconds", () => {
    const noon = new Date(2026, 0, 2, 12, 3, 4).getTime();
    expect(timeOfDay(noon)).toBe("12:03:04");
    expect(timeOfDay(noon - 12 * 3600 * 1000)).toBe("00:03:04");
  });

  it.each([
    [0.5, "just now"],
    [12.9, "12 s ago"],
    [179, "2 min ago"],
    [7300, "2 h ago"],
    [200000, "2 d ago"],
  ])("ago(%d) is %s", (seconds, text) => expect(ago(seconds)).toBe(text));

  it("says 100 percent only when all is there", () => {
    expect(percent(99_999, 100_000)).toBe(99);
    expect(percent(100_000, 100_000)).toBe(100);
    expect(percent(0, 0)).toBe(0);
  });

  it("has units for bytes and plurals for things", () => {
    expect([200, 20_480, 1.5 * 1024 * 1024, 200 * 1024 * 1024].map(bytes)).toEqual([
      "200 bytes",
      "20 kB",
      "1.5 MB",
      "200 MB",
    ]);
    expect([many(0, "worker"), many(1, "worker"), many(2000, "worker")]).toEqual([
      "0 workers",
      "1 worker",
      "2\u202f000 workers",
    ]);
  });
});
