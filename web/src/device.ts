// The table on the graphics device: the compute shader over columns on WebGPU, or the fragment shader on WebGL 2.
import type { Run } from "./api";

export type Api = "WebGPU" | "WebGL 2";

/** The words that a run is fed with. */
export interface Words {
  plain: Uint32Array<ArrayBuffer>;
  fetched?: Uint32Array<ArrayBuffer>;
  lookup?: Uint32Array<ArrayBuffer>;
}

export interface Ran {
  words: Uint32Array<ArrayBuffer>;
  api: Api;
  /** The device as the browser calls it. */
  device: string;
  /** Milliseconds from handing over to having the results, after compilation. */
  took: number;
}

let opened: Promise<GPUDevice | undefined> | undefined;
let name = "";

/** The WebGPU device; nothing, where there is none. */
function gpu(): Promise<GPUDevice | undefined> {
  opened ??= (async () => {
    const adapter = await navigator.gpu?.requestAdapter();
    const device = await adapter?.requestDevice();
    if (!adapter || !device) return undefined;
    const { vendor, architecture, description } = adapter.info;
    name = description || [vendor, architecture].filter(Boolean).join(" ");
    // A device that was lost is asked for anew.
    void device.lost.then(() => {
      opened = undefined;
    });
    return device;
  })().catch(() => undefined);
  return opened;
}

/** The interfaces that are there, the better first. */
export async function available(): Promise<Api[]> {
  const found: Api[] = [];
  if (await gpu()) found.push("WebGPU");
  if (document.createElement("canvas").getContext("webgl2")) found.push("WebGL 2");
  return found;
}

/** Runs a table over its points. */
export async function run(api: Api, what: Run, words: Words): Promise<Ran> {
  return api === "WebGPU" ? webgpu(what, words) : webgl(what, words);
}

async function webgpu(what: Run, words: Words): Promise<Ran> {
  const device = await gpu();
  if (!device) throw new Error("this browser offers no WebGPU device");
  let isLost = false;
  void device.lost.then(() => {
    isLost = true;
  });
  device.pushErrorScope("validation");
  device.pushErrorScope("out-of-memory");
  const module = device.createShaderModule({ code: what.wgsl });
  const messages = (await module.getCompilationInfo()).messages.filter(({ type }) => type === "error");
  const made = messages.length === 0 ? await device.createComputePipelineAsync({ layout: "auto", compute: { module } }).catch(String) : undefined;
  const buffers: GPUBuffer[] = [];
  const buffer = (size: number, usage: number) => {
    const made = device.createBuffer({ size, usage });
    buffers.push(made);
    return made;
  };
  const filled = (contents: Uint32Array<ArrayBuffer>) => {
    const made = buffer(contents.byteLength, GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST);
    device.queue.writeBuffer(made, 0, contents);
    return made;
  };
  try {
    if (messages[0]) throw new Error(`the browser refuses the WGSL: line ${messages[0].lineNum}: ${messages[0].message}`);
    if (made === undefined || typeof made === "string") throw new Error(`the browser makes no pipeline of the WGSL: ${made}`);
    const size = 4 * what.rows * what.out;
    const out = buffer(size, GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC);
    const back = buffer(size, GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST);
    const entries: [number, GPUBuffer][] = [[0, filled(words.plain)], [2, out]];
    if (words.fetched) entries.push([1, filled(words.fetched)]);
    if (words.lookup) entries.push([3, filled(words.lookup)]);
    const group = device.createBindGroup({
      layout: made.getBindGroupLayout(0),
      entries: entries.map(([binding, buffer]) => ({ binding, resource: { buffer } })),
    });
    const start = performance.now();
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginComputePass();
    pass.setPipeline(made);
    pass.setBindGroup(0, group);
    pass.dispatchWorkgroups(Math.ceil(what.rows / what.workgroup));
    pass.end();
    encoder.copyBufferToBuffer(out, 0, back, 0, size);
    device.queue.submit([encoder.finish()]);
    await back.mapAsync(GPUMapMode.READ);
    const took = performance.now() - start;
    const results = new Uint32Array(back.getMappedRange().slice(0));
    back.unmap();
    return { words: results, api: "WebGPU", device: name, took };
  } catch (error) {
    if (isLost) throw new Error("The device was lost while it computed. The next run asks for it anew.");
    throw error;
  } finally {
    buffers.forEach((buffer) => buffer.destroy());
    const errors = [await device.popErrorScope(), await device.popErrorScope()];
    const first = errors.find((error) => error !== null);
    // Where something was thrown that is the better message; this is what was not noticed otherwise.
    if (first) console.warn(first.message);
  }
}

async function webgl(what: Run, words: Words): Promise<Ran> {
  const side = Math.ceil(Math.sqrt(what.rows));
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2", { antialias: false, depth: false });
  if (!gl) throw new Error("this browser offers no WebGL 2");
  try {
    const texture = (width: number, height: number) => {
      gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
      for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
      if (width > gl.getParameter(gl.MAX_TEXTURE_SIZE) || height > gl.getParameter(gl.MAX_TEXTURE_SIZE)) {
        throw new Error("the device's textures are too small for so many points");
      }
    };
    const [plain, fetched, lookup, width] = what.uniforms;
    const inputs: [string, Uint32Array | undefined][] = [[plain, words.plain], [fetched, words.fetched], [lookup, words.lookup]];
    for (const [unit, [, contents]] of inputs.entries()) {
      if (!contents) continue;
      const height = Math.max(1, Math.ceil(contents.length / what.texels));
      gl.activeTexture(gl.TEXTURE0 + unit);
      texture(what.texels, height);
      const padded = new Uint32Array(what.texels * height);
      padded.set(contents);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32UI, what.texels, height, 0, gl.RED_INTEGER, gl.UNSIGNED_INT, padded);
    }
    gl.activeTexture(gl.TEXTURE3);
    const rows = Math.ceil(what.rows / side);
    texture(side, rows);
    const target = gl.getParameter(gl.TEXTURE_BINDING_2D) as WebGLTexture;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32UI, side, rows, 0, gl.RGBA_INTEGER, gl.UNSIGNED_INT, null);
    gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    gl.viewport(0, 0, side, rows);
    const results = new Uint32Array(what.rows * what.out);
    const programs = what.passes.map((fragment) => linked(gl, fragment));
    const start = performance.now();
    for (const [pass, program] of programs.entries()) {
      gl.useProgram(program);
      for (const [unit, [uniform]] of inputs.entries()) gl.uniform1i(gl.getUniformLocation(program, uniform), unit);
      gl.uniform1ui(gl.getUniformLocation(program, width), side);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      const texels = new Uint32Array(4 * side * rows);
      gl.readPixels(0, 0, side, rows, gl.RGBA_INTEGER, gl.UNSIGNED_INT, texels);
      for (let row = 0; row < what.rows; row++) {
        for (let word = 0; word < 4 && 4 * pass + word < what.out; word++) {
          results[row * what.out + 4 * pass + word] = texels[4 * row + word] ?? 0;
        }
      }
    }
    const took = performance.now() - start;
    if (gl.isContextLost()) throw new Error("the device was lost");
    const info = gl.getExtension("WEBGL_debug_renderer_info");
    const device = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
    return { words: results, api: "WebGL 2", device, took };
  } finally {
    gl.getExtension("WEBGL_lose_context")?.loseContext();
  }
}

/** A triangle that covers the target, and nothing to read. */
const VERTEX = `#version 300 es
void main() {
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}`;

function linked(gl: WebGL2RenderingContext, fragment: string): WebGLProgram {
  const program = gl.createProgram();
  const parts: [number, string][] = [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment]];
  const shaders = parts.map(([kind, source]) => {
    const shader = gl.createShader(kind);
    if (!shader) throw new Error("the device was lost");
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    return shader;
  });
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    const log = shaders.map((shader) => gl.getShaderInfoLog(shader)).join("") || gl.getProgramInfoLog(program);
    throw new Error(`the browser refuses the GLSL: ${log?.trim()}`);
  }
  return program;
}
