/** SHA-256 of the contract that this page was built with: `vite.config.ts`. */
declare const __CONTRACT__: string;
