/** What people may do, as it is called. */
import type { Role } from "../bench.svelte";
import type { WordKey } from "../words/words.svelte";

export const ROLES: readonly { role: Role; word: WordKey; help: WordKey }[] = [
	{ role: "reader", word: "role.reader", help: "role.reader.help" },
	{ role: "operator", word: "role.operator", help: "role.operator.help" },
	{ role: "reviewer", word: "role.reviewer", help: "role.reviewer.help" },
	{ role: "admin", word: "role.admin", help: "role.admin.help" },
];
