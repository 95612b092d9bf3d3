/** The arm in space, by three.js: a chunk of its own, loaded where WebGL is. Paints when something changed, else rests. */
import {
	AmbientLight,
	BufferGeometry,
	CanvasTexture,
	Color,
	CylinderGeometry,
	DirectionalLight,
	DoubleSide,
	Group,
	Line,
	LineBasicMaterial,
	LineDashedMaterial,
	type Material,
	Matrix4,
	Mesh,
	MeshBasicMaterial,
	MeshLambertMaterial,
	type Object3D,
	PerspectiveCamera,
	Scene,
	SphereGeometry,
	Sprite,
	SpriteMaterial,
	SRGBColorSpace,
	TorusGeometry,
	Vector3,
	WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { ConvexGeometry } from "three/addons/geometries/ConvexGeometry.js";
import type { Shape } from "../api/types";
import { type Frames, framesOf, type Past, type Picture, SHOWN_GROUPS } from "./picture";

export type Colours = (name: string) => string;

const SOLIDS: Record<string, string> = {
	foot: "arm-joint",
	joint: "arm-joint",
	cap: "arm-cap",
	mark: "arm-edge",
	link: "arm-link",
	probe: "arm-probe",
	tip: "arm-tip",
};
const LINES: Record<string, string> = {
	grid: "arm-grid",
	"grid-axis": "arm-grid-axis",
	axis: "arm-soft",
	sense: "arm-ink",
};
/** Of past touches, as a share of the reach. */
const DOT = 0.006;
const END = 0.011;

export class Arm3d {
	private readonly renderer: WebGLRenderer;
	private readonly scene = new Scene();
	private readonly camera = new PerspectiveCamera(32, 1, 1, 100000);
	private readonly controls: OrbitControls;
	private bodies: Group[] = [];
	private ghost = new Group();
	private marks = new Group();
	private asked = 0;
	private reach = 0;
	private readonly watcher: ResizeObserver;

	constructor(
		private readonly canvas: HTMLCanvasElement,
		private readonly colours: Colours,
		moving: boolean,
	) {
		this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
		this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
		this.camera.up.set(0, 0, 1);
		this.controls = new OrbitControls(this.camera, canvas);
		this.controls.enableDamping = false;
		this.controls.enabled = moving;
		this.controls.enableZoom = moving;
		this.controls.addEventListener("change", () => this.later());
		const sun = new DirectionalLight(0xffffff, 2.2);
		sun.position.set(-0.6, -1, 1.6);
		this.camera.add(new DirectionalLight(0xffffff, 0.7));
		this.scene.add(new AmbientLight(0xffffff, 1.5), sun, this.camera, this.ghost, this.marks);
		this.watcher = new ResizeObserver(() => this.resize());
		this.watcher.observe(canvas);
	}

	/** Anew, of what an arm is made of. */
	show(picture: Picture): void {
		for (const body of this.bodies) this.drop(body);
		this.bodies = picture.scene.bodies.bodies.map(() => fixed(new Group()));
		for (const body of this.bodies) this.scene.add(body);
		const unit = picture.scene.reach_mm;
		for (const shape of picture.scene.shapes) {
			if (!SHOWN_GROUPS.includes(shape.group)) continue;
			const made = this.made(shape, unit);
			if (made) this.bodies[shape.body]?.add(made);
		}
		this.move(framesOf(picture.scene.bodies));
		if (this.reach !== unit) this.look(unit);
		this.mark(picture);
	}

	/** The bodies where a frame has them. */
	move(frames: Frames): void {
		stand(this.bodies, frames);
		this.later();
	}

	/** What is not the arm: its ghost, the artefact, touches. */
	mark(picture: Picture): void {
		this.drop(this.ghost);
		this.drop(this.marks);
		this.ghost = new Group();
		this.marks = new Group();
		this.scene.add(this.ghost, this.marks);
		const unit = picture.scene.reach_mm;
		if (picture.ghost) this.haunt(picture, unit);
		for (const past of picture.past) this.marks.add(this.past(past, unit));
		const blue = this.solid("arm-z");
		const ends = picture.places.map((each) => new Vector3(...each));
		for (const end of ends) this.marks.add(ball(end, END * unit, blue));
		for (let k = 1; k < ends.length; k++) {
			const [from, to] = [ends[k - 1], ends[k]];
			if (from && to) this.marks.add(rod(from, to, 0.45 * END * unit, blue));
		}
		if (picture.goal) {
			const at = new Vector3(...picture.goal);
			const ring = new Mesh(
				new TorusGeometry(2.4 * END * unit, 0.35 * END * unit, 10, 40),
				this.flat("outlier"),
			);
			ring.position.copy(at);
			ring.onBeforeRender = () => ring.quaternion.copy(this.camera.quaternion);
			this.marks.add(ring, ball(at, 0.8 * END * unit, this.flat("outlier")));
		}
		this.later();
	}

	/** From where it is seen at first. */
	look(reach: number): void {
		this.reach = reach;
		const azimuth = (-58 * Math.PI) / 180;
		const elevation = (22 * Math.PI) / 180;
		const far = 2.7 * reach;
		this.camera.near = reach / 100;
		this.camera.far = 20 * reach;
		this.controls.target.set(0, 0, 0.26 * reach);
		this.camera.position.set(
			far * Math.cos(elevation) * Math.cos(azimuth),
			far * Math.cos(elevation) * Math.sin(azimuth),
			0.26 * reach + far * Math.sin(elevation),
		);
		this.controls.update();
		this.resize();
	}

	/** By keys: radians about the vertical and up, and a factor of the distance. */
	turn(about: number, up: number, closer = 1): void {
		const from = this.camera.position.clone().sub(this.controls.target);
		const far = from.length() * closer;
		const azimuth = Math.atan2(from.y, from.x) + about;
		const elevation = Math.min(1.5, Math.max(-0.4, Math.asin(from.z / from.length()) + up));
		this.camera.position
			.set(
				Math.cos(elevation) * Math.cos(azimuth),
				Math.cos(elevation) * Math.sin(azimuth),
				Math.sin(elevation),
			)
			.multiplyScalar(far)
			.add(this.controls.target);
		this.controls.update();
		this.later();
	}

	end(): void {
		cancelAnimationFrame(this.asked);
		this.watcher.disconnect();
		this.controls.dispose();
		this.scene.traverse(free);
		this.renderer.dispose();
	}

	private later(): void {
		this.asked ||= requestAnimationFrame(() => {
			this.asked = 0;
			this.renderer.render(this.scene, this.camera);
		});
	}

	private resize(): void {
		const { clientWidth: width, clientHeight: height } = this.canvas;
		if (!width || !height) return;
		this.renderer.setSize(width, height, false);
		this.camera.aspect = width / height;
		// a narrow picture shows as much to the sides as a square one
		this.camera.fov =
			width < height
				? (2 * Math.atan(Math.tan((16 * Math.PI) / 180) * (height / width)) * 180) / Math.PI
				: 32;
		this.camera.updateProjectionMatrix();
		// another size empties the picture: it is painted before anybody sees that
		this.renderer.render(this.scene, this.camera);
	}

	private solid(colour: string): Material {
		return new MeshLambertMaterial({ color: new Color(this.colours(colour)), side: DoubleSide });
	}

	private flat(colour: string): Material {
		return new MeshBasicMaterial({ color: new Color(this.colours(colour)) });
	}

	private made(shape: Shape, unit: number): Object3D | null {
		const points = shape.points_mm.map(([x, y, z]) => new Vector3(x, y, z));
		const at = points[0];
		switch (shape.kind) {
			case "line":
				return this.line(shape.role, points);
			case "ball":
				return at ? ball(at, Math.max(shape.radius_mm, 0.007 * unit), this.solid("arm-tip")) : null;
			case "word":
				return at && shape.role === "axis-name" ? this.word(String(shape.joint), at, 0.055 * unit) : null;
			case "solid":
				return solid(points, this.solid(SOLIDS[shape.role] ?? "arm-ink"));
			case "face":
				return solid(points, this.solid(SOLIDS[shape.role] ?? "arm-ink"), true);
		}
	}

	private line(role: string, points: Vector3[]): Line {
		const colour = new Color(this.colours(LINES[role] ?? "arm-soft"));
		const dashes = this.reach / 60 || 10;
		const material =
			role === "axis"
				? new LineDashedMaterial({ color: colour, dashSize: dashes, gapSize: dashes / 2 })
				: new LineBasicMaterial({ color: colour });
		const made = new Line(new BufferGeometry().setFromPoints(points), material);
		if (role === "axis") made.computeLineDistances();
		return made;
	}

	private word(text: string, at: Vector3, size: number): Sprite {
		const canvas = document.createElement("canvas");
		canvas.width = canvas.height = 64;
		const pen = canvas.getContext("2d");
		if (pen) {
			pen.font = "700 40px system-ui, sans-serif";
			pen.textAlign = "center";
			pen.textBaseline = "middle";
			pen.lineWidth = 8;
			pen.strokeStyle = this.colours("arm-paper");
			pen.strokeText(text, 32, 34);
			pen.fillStyle = this.colours("arm-ink");
			pen.fillText(text, 32, 34);
		}
		const texture = new CanvasTexture(canvas);
		texture.colorSpace = SRGBColorSpace;
		const made = new Sprite(new SpriteMaterial({ map: texture, depthTest: false }));
		made.position.copy(at);
		made.scale.setScalar(size);
		return made;
	}

	private past(past: Past, unit: number): Object3D {
		const at = new Vector3(...past.at);
		switch (past.kind) {
			case "fitted":
				return ball(at, DOT * unit, this.flat("arm-soft"));
			case "held-out":
				return ball(at, DOT * unit, this.flat("second"));
			case "odd":
				return ball(at, 1.6 * DOT * unit, this.flat("outlier"));
		}
	}

	private haunt(picture: Picture, unit: number): void {
		if (!picture.ghost) return;
		const bodies = picture.scene.bodies.bodies.map(() => fixed(new Group()));
		const material = new MeshLambertMaterial({
			color: new Color(this.colours("main")),
			transparent: true,
			opacity: 0.3,
			depthWrite: false,
		});
		for (const shape of picture.scene.shapes) {
			if (shape.group !== "arm" || shape.kind === "face" || shape.role === "foot") continue;
			const points = shape.points_mm.map(([x, y, z]) => new Vector3(x, y, z));
			const at = points[0];
			const made = shape.kind === "ball" ? at && ball(at, 0.007 * unit, material) : solid(points, material);
			if (made) bodies[shape.body]?.add(made);
		}
		stand(bodies, framesOf(picture.ghost));
		this.ghost.add(...bodies);
	}

	private drop(group: Group): void {
		group.traverse(free);
		group.removeFromParent();
	}
}

function fixed(group: Group): Group {
	group.matrixAutoUpdate = false;
	return group;
}

const matrix = new Matrix4();

function stand(bodies: readonly Group[], frames: Frames): void {
	bodies.forEach((body, index) => {
		const m = (k: number) => frames[12 * index + k] ?? 0;
		matrix.set(m(0), m(1), m(2), m(3), m(4), m(5), m(6), m(7), m(8), m(9), m(10), m(11), 0, 0, 0, 1);
		body.matrix.copy(matrix);
		body.matrixWorldNeedsUpdate = true;
	});
}

function ball(at: Vector3, radius: number, material: Material): Mesh {
	const made = new Mesh(new SphereGeometry(radius, 20, 14), material);
	made.position.copy(at);
	return made;
}

function rod(from: Vector3, to: Vector3, radius: number, material: Material): Mesh {
	const along = to.clone().sub(from);
	const made = new Mesh(new CylinderGeometry(radius, radius, along.length(), 14), material);
	made.position.copy(from).addScaledVector(along, 0.5);
	made.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), along.normalize());
	return made;
}

/** The hull of points; a face is a fan. */
function solid(points: Vector3[], material: Material, face = false): Mesh | null {
	if (points.length < (face ? 3 : 4)) return null;
	if (!face) return new Mesh(new ConvexGeometry(points), material);
	const geometry = new BufferGeometry().setFromPoints(points);
	const fan: number[] = [];
	for (let k = 1; k + 1 < points.length; k++) fan.push(0, k, k + 1);
	geometry.setIndex(fan);
	geometry.computeVertexNormals();
	return new Mesh(geometry, material);
}

function free(object: Object3D): void {
	if (!(object instanceof Mesh || object instanceof Line || object instanceof Sprite)) return;
	object.geometry.dispose();
	const materials: Material[] = Array.isArray(object.material) ? object.material : [object.material];
	for (const material of materials) {
		if (material instanceof SpriteMaterial) material.map?.dispose();
		material.dispose();
	}
}
