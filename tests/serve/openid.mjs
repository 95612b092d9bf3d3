// A real OpenID provider (the certified `oidc-provider`) with one client, for tests: node openid.mjs PORT REDIRECT SECRET.
// Whoever signs in as "erika" is erika@lab.example; the address of "unverified" is not verified.
import { createRequire } from "node:module";

const require = createRequire(new URL("../../page/package.json", import.meta.url));
const { default: Provider } = await import(require.resolve("oidc-provider"));
const [port, redirect, secret] = process.argv.slice(2);
const issuer = `http://127.0.0.1:${port}`;
const provider = new Provider(issuer, {
	clients: [
		{
			client_id: "ulna",
			client_secret: secret,
			redirect_uris: [redirect],
			grant_types: ["authorization_code"],
			response_types: ["code"],
		},
	],
	claims: { openid: ["sub"], email: ["email", "email_verified"], profile: ["preferred_username"] },
	cookies: { keys: ["a key of tests"] },
	findAccount: (_, id) => ({
		accountId: id,
		claims: () => ({
			sub: id,
			email: `${id}@lab.example`,
			email_verified: id !== "unverified",
			preferred_username: id,
		}),
	}),
	features: { devInteractions: { enabled: true } },
	pkce: { required: () => true },
});
provider.listen(Number(port), "127.0.0.1", () => console.log("listening"));
