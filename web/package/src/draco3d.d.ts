// What npm's draco3d has no types for.
declare module "draco3d/draco_encoder_nodejs.js" {
  const create: unknown;
  export default create;
}
declare module "draco3d/draco_decoder_nodejs.js" {
  const create: unknown;
  export default create;
}
