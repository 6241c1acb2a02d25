// Writes WebM files, from pictures that the browser has encoded.
export { BufferTarget, EncodedPacket, EncodedVideoPacketSource, Output, WebMOutputFormat } from "mediabunny";
