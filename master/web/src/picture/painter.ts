// Paints layers with WebGL2, when told to.
import type { Display } from "./display";
import { relativeFloor } from "./difference";
import { LayerData } from "./layer_data";
import { fragmentSource, kinds, metricNumbers, paletteEntries, toneNumbers, vertexSource } from "./shader";
import { LayerTextures, texture } from "./textures";
import type { Point, Size } from "./view";

/// How the numbers of a layer, or of a difference, become colours.
export interface Look {
  kind: keyof typeof kinds; // plain: they are colours already
  display: Display; // of picture
  table: Uint8Array; // paletteEntries colours: of scalar, label, and some tones of picture
  low: number; // of scalar, as all below
  high: number;
  logStep: number; // 0: linear
  flatPosition: number; // in the table when low is high
  nothingIsBlack: boolean; // infinite means that there is nothing; else it is marked as is NaN
}

export interface Part {
  data: LayerData;
  other: LayerData | null; // for metrics other than none; of the same shape
  metric: keyof typeof metricNumbers;
  look: Look;
  origin: Point; // the layer's corner on the screen, device pixels
  texel: number; // a layer pixel's side there
  left: number; // nothing is painted left of this
  right: number; // or right of this
  grid: number; // how strong, 0 to 1
}

/// A canvas, of the page or not.
export interface Surface {
  getContext(kind: "webgl2", options?: WebGLContextAttributes): WebGL2RenderingContext | null;
}

const mostTextures = 6; // layers on the graphics card

export class Painter {
  private readonly gl: WebGL2RenderingContext;
  private readonly program: WebGLProgram;
  private readonly uniforms = new Map<string, WebGLUniformLocation | null>();
  private readonly palette: WebGLTexture;
  private table: Uint8Array | null = null; // in the palette
  private readonly textures = new Map<LayerData, LayerTextures>();
  private readonly longestSide: number;
  private frame = 0;

  constructor(canvas: Surface) {
    const gl = canvas.getContext("webgl2", {
      alpha: false,
      antialias: false,
      depth: false,
      preserveDrawingBuffer: true,
    });
    if (!gl) throw new Error("This browser has no WebGL2, which the picture is painted with.");
    this.gl = gl;
    this.program = programOf(gl);
    this.palette = texture(gl, gl.RGBA8, paletteEntries, 1);
    this.longestSide = gl.getParameter(gl.MAX_TEXTURE_SIZE) as number;
  }

  paint(screen: Size, density: number, ground: [number, number, number], parts: readonly Part[]): void {
    const { gl } = this;
    ++this.frame;
    gl.viewport(0, 0, screen.width, screen.height);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(ground[0], ground[1], ground[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST);
    gl.useProgram(this.program);
    this.number("screen_height", screen.height);
    this.number("density", density);
    for (const part of parts) {
      const left = Math.max(0, Math.round(part.left));
      gl.scissor(left, 0, Math.max(0, Math.round(part.right) - left), screen.height);
      this.paintPart(part);
    }
    this.forget();
  }

  private paintPart(part: Part): void {
    const { gl } = this;
    const corner = [-part.origin.x / part.texel, -part.origin.y / part.texel] as const;
    const base = corner.map(Math.floor) as [number, number];
    gl.uniform2i(this.at("base"), ...base);
    gl.uniform2f(this.at("fraction"), corner[0] - base[0], corner[1] - base[1]);
    this.number("texel", part.texel);
    this.number("grid", part.grid);
    this.integer("channels", part.data.channels);
    this.integer("metric", metricNumbers[part.metric]);
    this.setLook(part.look);
    const own = this.texturesOf(part.data);
    const others = part.other && this.texturesOf(part.other);
    this.bind("palette", 2, this.palette);
    own.chunks.forEach((chunk, i) => {
      const other = others?.chunks[i] ?? chunk;
      this.bind("values", 0, chunk.values);
      this.bind("there", 1, chunk.there);
      this.bind("other_values", 3, other.values);
      this.bind("other_there", 4, other.there);
      gl.uniform4i(this.at("chunk"), chunk.area.x, chunk.area.y, chunk.area.width, chunk.area.height);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    });
  }

  private setLook(look: Look): void {
    const { gl } = this;
    this.integer("kind", kinds[look.kind]);
    this.integer("tone", toneNumbers[look.display.tone]);
    this.integer("clip", Number(look.display.clip));
    this.integer("zebra", Number(look.display.zebra));
    this.integer("nothing_is_black", Number(look.nothingIsBlack));
    this.number("exposure", look.display.exposure);
    this.number("offset", look.display.offset);
    this.number("gamma", look.display.gamma);
    this.number("low", look.low);
    this.number("high", look.high);
    this.number("log_step", look.logStep);
    this.number("flat_position", look.flatPosition);
    this.number("relative_floor", relativeFloor);
    if (look.table === this.table) return;
    this.table = look.table;
    gl.activeTexture(gl.TEXTURE2);
    gl.bindTexture(gl.TEXTURE_2D, this.palette);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, paletteEntries, 1, gl.RGBA, gl.UNSIGNED_BYTE, look.table);
  }

  private texturesOf(data: LayerData): LayerTextures {
    let found = this.textures.get(data);
    this.gl.activeTexture(this.gl.TEXTURE0);
    if (found) found.update();
    else this.textures.set(data, (found = new LayerTextures(this.gl, data, this.longestSide)));
    found.used = this.frame;
    return found;
  }

  private forget(): void {
    const oldest = [...this.textures].sort(([, a], [, b]) => a.used - b.used);
    for (const [data, textures] of oldest.slice(0, Math.max(0, oldest.length - mostTextures))) {
      textures.free();
      this.textures.delete(data);
    }
  }

  private at(name: string): WebGLUniformLocation | null {
    if (!this.uniforms.has(name)) this.uniforms.set(name, this.gl.getUniformLocation(this.program, name));
    return this.uniforms.get(name)!;
  }
  private number(name: string, value: number): void {
    this.gl.uniform1f(this.at(name), value);
  }
  private integer(name: string, value: number): void {
    this.gl.uniform1i(this.at(name), value);
  }
  private bind(name: string, unit: number, what: WebGLTexture): void {
    this.gl.activeTexture(this.gl.TEXTURE0 + unit);
    this.gl.bindTexture(this.gl.TEXTURE_2D, what);
    this.integer(name, unit);
  }
}

function programOf(gl: WebGL2RenderingContext): WebGLProgram {
  const program = gl.createProgram();
  for (const [kind, source] of [
    [gl.VERTEX_SHADER, vertexSource],
    [gl.FRAGMENT_SHADER, fragmentSource],
  ] as const) {
    const shader = gl.createShader(kind)!;
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
      throw new Error(`The picture's shader does not compile: ${gl.getShaderInfoLog(shader)}`);
  }
  gl.linkProgram(program);
  return program;
}
