/** By what a touch is taken. */
export type By = "still" | "button" | "key";
