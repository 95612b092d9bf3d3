/** Read by the build and by svelte-check alike. */
export default { compilerOptions: { runes: true } };
