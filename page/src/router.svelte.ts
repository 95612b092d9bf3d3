/** Where somebody is: the path, and nothing else. Every screen has one, so that it can be kept, sent and gone back to. */
export interface Place {
	/** "/results", without what follows. */
	screen: string;
	/** What follows: an id or a name, decoded; null: none. */
	rest: string | null;
	query: URLSearchParams;
}

let place = $state.raw<Place>(
	placeOf(typeof location === "undefined" ? "/" : location.pathname + location.search),
);

export function here(): Place {
	return place;
}

/** "/results/ab%20c?x=1" in its parts. */
export function placeOf(path: string): Place {
	const [plain = "/", query = ""] = path.split("?", 2);
	const parts = plain.split("/").filter((each) => each !== "");
	const rest = parts.slice(1).map(decoded).join("/");
	return { screen: `/${parts[0] ?? ""}`, rest: rest || null, query: new URLSearchParams(query) };
}

/** The path of a screen with an id or a name behind it. */
export function pathOf(
	screen: string,
	rest: string | null = null,
	query: Record<string, string> = {},
): string {
	const asked = new URLSearchParams(query).toString();
	return screen + (rest ? `/${encodeURIComponent(rest)}` : "") + (asked ? `?${asked}` : "");
}

export function go(path: string, instead = false): void {
	if (instead) history.replaceState(null, "", path);
	else history.pushState(null, "", path);
	place = placeOf(path);
	scrollTo(0, 0);
}

/** Links stay in the page; back and forward are the browser's. */
export function begin(): void {
	addEventListener("popstate", () => {
		place = placeOf(location.pathname + location.search);
	});
	document.addEventListener("click", (event) => {
		if (
			event.defaultPrevented ||
			event.button !== 0 ||
			event.metaKey ||
			event.ctrlKey ||
			event.shiftKey ||
			event.altKey
		)
			return;
		const link = (event.target as Element | null)?.closest("a");
		if (!link || link.target || link.hasAttribute("download") || link.origin !== location.origin) return;
		if (link.pathname.startsWith("/api/") || link.getAttribute("href")?.startsWith("#")) return;
		event.preventDefault();
		go(link.pathname + link.search);
	});
}

function decoded(part: string): string {
	try {
		return decodeURIComponent(part);
	} catch {
		return part;
	}
}
