import type { IconName } from "./icons";

export type Tone = "good" | "bad" | "warn" | "soft";
export const MARK_ICONS: Record<Tone, IconName> = { good: "good", bad: "bad", warn: "warn", soft: "open" };
