/** The newest of a stream as bytes: as `python/ulna/serve/frames.py` packs it, little-endian. */
export const STILL = 1;
export const DOUBTFUL = 2;
export const AT_STOP = 4;
export const NOT_DETERMINED = 8;
export const ARM = 16;
const KIND = 1;
const HEAD = 16;

export interface Frame {
	flags: number;
	number: number;
	tS: number;
	/** rad; of joints that slide, mm. */
	qRad: Float64Array;
	tipMm: Float64Array;
	/** For how much of the time for which it must the tip has been resting: 0 to 1. */
	rests: number;
	/** Twelve for each body, the base first. */
	bodies: Float32Array;
}

/** Null: nothing that this page knows. */
export function frameOf(bytes: ArrayBuffer): Frame | null {
	if (bytes.byteLength < HEAD) return null;
	const view = new DataView(bytes);
	const joints = view.getUint8(1);
	const doubles = joints + 3;
	const floats = 7 + 12 * (joints + 1);
	if (view.getUint8(0) !== KIND || bytes.byteLength !== HEAD + 8 * doubles + 4 * floats) return null;
	const float = HEAD + 8 * doubles;
	return {
		flags: view.getUint16(2, true),
		number: view.getUint32(4, true),
		tS: view.getFloat64(8, true),
		qRad: new Float64Array(bytes, HEAD, joints),
		tipMm: new Float64Array(bytes, HEAD + 8 * joints, 3),
		rests: view.getFloat32(float + 24, true),
		bodies: new Float32Array(bytes, float + 28, 12 * (joints + 1)),
	};
}
