// A post file of the user's own, and the server's dialects as files to begin with.
import { byId } from "../../viewer/src/page_elements";
import { download } from "./downloads";
import { isFile, type OwnPost, readPost, settingOfFile } from "./own_post";
import type { Choice } from "./settings";

interface Dialect {
  name: string;
  postFile: string;
}

export function makePostPanel(choice: Choice, take: (post: OwnPost) => void, onError: (error: unknown) => void): { setPosts: (posts: readonly Dialect[]) => void } {
  const input = byId<HTMLInputElement>("post-file");
  const save = byId("post-save");
  let dialects: readonly Dialect[] = [];
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    input.value = "";
    if (file === undefined) return;
    readPost(file)
      .then((post) => {
        choice.set("post", settingOfFile(post.name));
        take(post);
      })
      .catch(onError);
  });
  save.addEventListener("click", () => {
    const post = choice.get("post");
    const dialect = dialects.find((d) => d.name === post);
    if (dialect !== undefined) download(`${dialect.name}.post`, dialect.postFile, "text/plain");
    else onError(new Error(isFile(post) ? "The post file is your own. Choose a control of the list to save its file." : `There is no control "${post.slice(0, 60)}".`));
  });
  return { setPosts: (posts) => void (dialects = posts) };
}
