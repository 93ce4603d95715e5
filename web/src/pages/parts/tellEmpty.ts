import { notifications } from "@mantine/notifications";

/** A folder without files: nothing would happen otherwise, and nobody would know why. */
export const tellEmpty = (): void => {
  notifications.show({ color: "red", title: "Nothing to import", message: "There are no files in what you chose. Choose the folder that holds the images or videos." });
};
