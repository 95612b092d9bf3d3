export interface Column {
	key: string;
	title: string;
	/** Right-aligned, never broken. */
	number?: boolean;
}
