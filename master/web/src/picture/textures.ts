// A layer's numbers on the graphics card: as they are, in pieces no larger than it takes.
import { overlap, whole, type LayerData, type Rect } from "./layer_data";

interface Chunk {
  area: Rect;
  values: WebGLTexture; // floats
  there: WebGLTexture; // bytes
}

export class LayerTextures {
  readonly chunks: Chunk[] = [];
  used = 0; // when it was last painted, in frames

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly data: LayerData,
    longestSide: number,
  ) {
    for (let y = 0; y < data.height; y += longestSide)
      for (let x = 0; x < data.width; x += longestSide) {
        const width = Math.min(longestSide, data.width - x);
        const height = Math.min(longestSide, data.height - y);
        const format = data.channels === 1 ? gl.R32F : gl.RGB32F;
        this.chunks.push({
          area: { x, y, width, height },
          values: texture(gl, format, width, height),
          there: texture(gl, gl.R8UI, width, height),
        });
      }
    this.upload(whole(data));
  }

  /// What has changed since the last time.
  update(): void {
    for (const area of this.data.takeChanges()) this.upload(area);
  }

  private upload(area: Rect): void {
    for (const chunk of this.chunks) {
      const part = overlap(area, chunk.area);
      if (part) this.uploadPart(chunk, part);
    }
    for (const name of [this.gl.UNPACK_ROW_LENGTH, this.gl.UNPACK_SKIP_PIXELS, this.gl.UNPACK_SKIP_ROWS])
      this.gl.pixelStorei(name, 0);
  }

  private uploadPart(chunk: Chunk, part: Rect): void {
    const { gl, data } = this;
    const [x, y] = [part.x - chunk.area.x, part.y - chunk.area.y];
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.pixelStorei(gl.UNPACK_ROW_LENGTH, data.width);
    gl.pixelStorei(gl.UNPACK_SKIP_PIXELS, part.x);
    gl.pixelStorei(gl.UNPACK_SKIP_ROWS, part.y);
    const format = data.channels === 1 ? gl.RED : gl.RGB;
    gl.bindTexture(gl.TEXTURE_2D, chunk.values);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, x, y, part.width, part.height, format, gl.FLOAT, data.values);
    gl.bindTexture(gl.TEXTURE_2D, chunk.there);
    gl.texSubImage2D(
      gl.TEXTURE_2D,
      0,
      x,
      y,
      part.width,
      part.height,
      gl.RED_INTEGER,
      gl.UNSIGNED_BYTE,
      data.there,
    );
  }

  free(): void {
    for (const chunk of this.chunks) {
      this.gl.deleteTexture(chunk.values);
      this.gl.deleteTexture(chunk.there);
    }
  }
}

/// Floats cannot be filtered everywhere, and are not to be.
export function texture(
  gl: WebGL2RenderingContext,
  format: GLenum,
  width: number,
  height: number,
): WebGLTexture {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
    gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
    gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
  return made;
}
