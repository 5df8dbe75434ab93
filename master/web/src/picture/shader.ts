// The program that colours the screen's pixels: nearest pixel of the layer, difference to another one, and from
// its value to a colour.

export const vertexSource = `#version 300 es
void main() {  // one triangle over the whole screen
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`;

/// The numbers that the program knows looks, tones and metrics by.
export const kinds = { picture: 0, scalar: 1, normal: 2, label: 3, plain: 4 } as const;
export const toneNumbers = { gamma: 0, srgb: 1, reinhard: 2, aces: 3, false: 4, signed: 5 } as const;
export const metricNumbers = { none: 0, absolute: 1, signed: 2, relative: 3 } as const;
export const paletteEntries = 1021; // a multiple of 255 steps and the end: all the rainbow's colours are in it

const values = `
vec3 value_of(ivec2 p) {
  vec3 a = texelFetch(values, p, 0).rgb;
  if (channels == 1) a = a.rrr;
  if (metric == 0) return a;
  vec3 b = texelFetch(other_values, p, 0).rgb;
  if (channels == 1) b = b.rrr;
  vec3 d = metric == 2 ? a - b : abs(a - b);
  if (metric == 3) d /= abs(b) + relative_floor;
  return mix(d, vec3(0.0), equal(a, b));  // equal infinities do not differ
}

bool any_nan(vec3 v) { return any(greaterThan(floatBitsToUint(v) & 0x7fffffffu, uvec3(0x7f800000u))); }
bool any_infinite(vec3 v) { return any(equal(floatBitsToUint(v) & 0x7fffffffu, uvec3(0x7f800000u))); }
`;

const colors = `
vec3 from_table(float t) {
  int last = ${paletteEntries - 1};
  return texelFetch(palette, ivec2(clamp(int(t * float(last) + 0.5), 0, last), 0), 0).rgb;
}

vec3 toned(vec3 v) {
  if (tone == 4) return from_table(log2(max((v.r + v.g + v.b) / 3.0, 0.0) + 1.0 / 32.0) / 10.0 + 0.5);
  if (tone == 5) return from_table(clamp((v.r + v.g + v.b) / 3.0, -1.0, 1.0) * 0.5 + 0.5);
  v = max(v, 0.0);
  if (tone == 1) return mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
  if (tone == 2) v = v / (1.0 + v);
  // Source: K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
  if (tone == 3) v = v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14);
  return pow(v, vec3(1.0 / gamma));
}

vec3 picture_color(vec3 v) {
  v = v * exp2(exposure) + offset;
  bool stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 8.0 * density) < 4.0 * density;
  if (zebra && any(greaterThan(v, vec3(1.0)))) return stripe ? vec3(0.0) : vec3(1.0, 0.85, 0.2);
  if (zebra && any(lessThan(v, vec3(0.0)))) return stripe ? vec3(0.0) : vec3(0.2, 0.6, 1.0);
  return toned(clip ? clamp(v, 0.0, 1.0) : v);
}

float position_of(float v) {
  if (!(high > low)) return flat_position;
  if (log_step == 0.0) return (v - low) / (high - low);
  return log(1.0 + max(0.0, v - low) / log_step) / log(1.0 + (high - low) / log_step);
}

vec3 color_of(vec3 v) {
  const vec3 mark = vec3(1.0, 0.0, 1.0);
  if (any_nan(v)) return mark;
  if (any_infinite(v)) return nothing_is_black ? vec3(0.0) : mark;
  if (kind == 0) return picture_color(v);
  if (kind == 1) return from_table(position_of((v.r + v.g + v.b) / 3.0));
  if (kind == 2) return vec3(floor((v.rg + 1.0) * 127.499), 255.0 - floor((v.b + 1.0) * 127.499)) / 255.0;
  if (kind == 3) return texelFetch(palette, ivec2(int(v.r) % ${paletteEntries}, 0), 0).rgb;
  return v;
}
`;

export const fragmentSource = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
uniform sampler2D values, other_values, palette;
uniform usampler2D there, other_there;
uniform ivec4 chunk;  // of the layer that the textures hold: x, y, width, height
uniform ivec2 base;  // the layer's pixel in the screen's upper left corner,
uniform vec2 fraction;  // and where in it: together exact at any zoom
uniform float texel, screen_height, density, grid;
uniform int channels, metric, kind, tone;
uniform float exposure, offset, gamma, low, high, log_step, flat_position, relative_floor;
uniform bool clip, zebra, nothing_is_black;
out vec4 color;
${values}${colors}
/// Nothing to show yet: a quiet chequer.
vec3 absent() {
  vec2 square = floor(gl_FragCoord.xy / (8.0 * density));
  return vec3(mod(square.x + square.y, 2.0) < 1.0 ? 0.16 : 0.19);
}

void main() {
  vec2 at = fraction + vec2(gl_FragCoord.x, screen_height - gl_FragCoord.y) / texel;
  ivec2 p = base + ivec2(floor(at)) - chunk.xy;
  if (any(lessThan(p, ivec2(0))) || any(greaterThanEqual(p, chunk.zw))) discard;
  bool missing = texelFetch(there, p, 0).r == 0u || (metric != 0 && texelFetch(other_there, p, 0).r == 0u);
  vec3 shown = clamp(missing ? absent() : color_of(value_of(p)), 0.0, 1.0);
  bool line = any(lessThan(fract(at) * texel, vec2(1.0)));
  if (line) shown = mix(shown, vec3(dot(shown, vec3(0.299, 0.587, 0.114)) < 0.5 ? 1.0 : 0.0), grid);
  color = vec4(shown, 1.0);
}`;
