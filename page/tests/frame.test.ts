import { expect, it } from "vitest";
import { ARM, frameOf, STILL } from "../src/api/frame";

/** As `packed` of python/ulna/serve/frames.py writes it. */
function packed(joints: number): ArrayBuffer {
	const bytes = new ArrayBuffer(16 + 8 * (joints + 3) + 4 * (7 + 12 * (joints + 1)));
	const view = new DataView(bytes);
	view.setUint8(0, 1);
	view.setUint8(1, joints);
	view.setUint16(2, STILL | ARM, true);
	view.setUint32(4, 77, true);
	view.setFloat64(8, 12.5, true);
	for (let k = 0; k < joints + 3; k++) view.setFloat64(16 + 8 * k, k + 0.25, true);
	const floats = 16 + 8 * (joints + 3);
	for (let k = 0; k < 7 + 12 * (joints + 1); k++) view.setFloat32(floats + 4 * k, k, true);
	return bytes;
}

it("reads what the server packs", () => {
	const frame = frameOf(packed(2));
	expect(frame).toMatchObject({ flags: 17, number: 77, tS: 12.5, rests: 6 });
	expect([...(frame?.qRad ?? [])]).toEqual([0.25, 1.25]);
	expect([...(frame?.tipMm ?? [])]).toEqual([2.25, 3.25, 4.25]);
	expect(frame?.bodies.length).toBe(36);
	expect(frame?.bodies[0]).toBe(7);
	expect(frame?.bodies[35]).toBe(42);
});

it("takes nothing that is cut, of another kind, or empty", () => {
	expect(frameOf(packed(6).slice(0, -1))).toBeNull();
	expect(frameOf(new ArrayBuffer(3))).toBeNull();
	const other = packed(1);
	new DataView(other).setUint8(0, 9);
	expect(frameOf(other)).toBeNull();
});
