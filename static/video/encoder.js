// Writes a WebM file from pictures, which the browser's own encoder (WebCodecs) compresses.

import { BufferTarget, EncodedPacket, EncodedVideoPacketSource, Output, WebMOutputFormat } from "../vendor/mediabunny.js";

const CODECS = { vp9: "vp09.00.50.08", vp8: "vp8" }; // of WebM, the better one first
const BITS = 0.15; // of the file, per pixel and picture
const MAX_BITS = 8e6; // of the file, per second: ten minutes fit into memory
const BETWEEN_KEYS = 60; // pictures from one that players can jump to, to the next
const MAX_QUEUED = 4; // pictures that wait to be compressed

/** Returns the settings of an encoder for a size [pixels] and a number of pictures a second, as [codec, settings]; null if this browser
 * has none. */
export async function encoderFor({ width, height }, rate) {
  if (typeof VideoEncoder === "undefined") return null;
  for (const [name, codec] of Object.entries(CODECS)) {
    const settings = { codec, width, height, framerate: rate, bitrate: Math.round(Math.min(MAX_BITS, BITS * width * height * rate)) };
    if ((await VideoEncoder.isConfigSupported(settings)).supported) return [name, settings];
  }
  return null;
}

export class VideoFile {
  /** @param chosen What `encoderFor` has returned. */
  constructor([codec, settings]) {
    this.rate = settings.framerate;
    this.output = new Output({ format: new WebMOutputFormat(), target: new BufferTarget() });
    const track = new EncodedVideoPacketSource(codec);
    this.output.addVideoTrack(track, { frameRate: this.rate });
    this.written = this.output.start();
    this.failure = null;
    this.failed = new Promise((_, reject) => {
      this.fail = (error) => reject((this.failure ??= error));
    });
    this.failed.catch(() => {}); // those who wait get it
    const write = (chunk, more) => {
      this.written = this.written.then(() => track.add(EncodedPacket.fromEncodedChunk(chunk), more));
      this.written.catch(this.fail);
    };
    this.encoder = new VideoEncoder({ output: write, error: this.fail });
    this.encoder.configure(settings);
  }

  /** Adds the picture with a number, counted from 0; waits while too many are being compressed. */
  async add(canvas, number) {
    while (this.encoder.encodeQueueSize >= MAX_QUEUED) {
      await Promise.race([new Promise((done) => this.encoder.addEventListener("dequeue", done, { once: true })), this.failed]);
    }
    if (this.failure) throw this.failure;
    const at = (count) => Math.round((count * 1e6) / this.rate);
    const picture = new VideoFrame(canvas, { timestamp: at(number), duration: at(number + 1) - at(number) });
    this.encoder.encode(picture, { keyFrame: number % BETWEEN_KEYS === 0 });
    picture.close();
  }

  /** Returns the whole file. */
  async finish() {
    await Promise.race([this.encoder.flush(), this.failed]);
    await this.written;
    await this.output.finalize();
    return new Blob([this.output.target.buffer], { type: "video/webm" });
  }

  /** Frees the encoder. */
  close() {
    if (this.encoder.state !== "closed") this.encoder.close();
  }
}
