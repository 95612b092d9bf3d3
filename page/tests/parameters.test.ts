import { expect, it } from "vitest";
import { parameterWords } from "../src/widgets/parameters";

it("says a parameter as the command does", () => {
	const said = (name: string) => parameterWords({ name, words: `server: ${name}` });
	expect(said("joint.6.theta0")).toBe("zero of joint 6");
	expect(said("joint.2.beta")).toBe("tilt of joint 2");
	expect(said("probe.bent.x")).toBe("x of probe bent");
	expect(said("joint.3.gear")).toBe("server: joint.3.gear");
	expect(said("bar.length")).toBe("server: bar.length");
});
