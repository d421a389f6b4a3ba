// How near the eye is to the nearest ground, water or cloud of the body. A pipeline for distant views leaves out the
// detail that no pixel of them resolves (src/render/nearness.rs): software adapters run both branches of an `if`.
override NEARNESS: u32 = 2u;
const FROM_ORBIT: u32 = 0u;
const FROM_AIR: u32 = 1u;
const FROM_GROUND: u32 = 2u;
