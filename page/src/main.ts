import { mount } from "svelte";
import App from "./App.svelte";
import { begin as beginLook } from "./look.svelte";
import { begin as beginRouter } from "./router.svelte";
import { enter } from "./signin";
import { wake } from "./tones";
import { firstLanguage, speak } from "./words/words.svelte";
import "./look/tokens.css";
import "./look/base.css";

beginLook();
beginRouter();
for (const kind of ["pointerdown", "keydown"]) addEventListener(kind, wake, { passive: true });
const target = document.getElementById("page");
if (target) {
	const entered = enter();
	await speak(firstLanguage(), false);
	mount(App, { target });
	await entered;
}
